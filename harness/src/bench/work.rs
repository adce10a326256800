//! Operations and bytes of a kernel invocation, counted from its code.
//!
//! The counter walks the statements of naga, calls included. It takes the more expensive branch, and one iteration of each loop:
//! the numbers are those of the longest path, and exact for a kernel without loops and without branches other than early exits,
//! such as the plain kernels of the fluid. Drivers may need fewer operations, since they compute common subexpressions once.

use riprap::{
    gpu::link::Linked,
    wgpu::naga::{
        self, AddressSpace, BinaryOperator, Block, Expression, Handle, MathFunction, Module,
        ScalarKind, Statement, TypeInner, valid::FunctionInfo,
    },
};

/// Operations and bytes of an invocation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Additions, subtractions, multiplications, divisions, roots, minima and maxima of f32, among others: one per component.
    /// Signs, comparisons and conversions are free.
    pub flops: u64,
    /// Bytes read from storage buffers.
    pub read: u64,
    /// Bytes written to storage buffers.
    pub written: u64,
    /// Loops, of which one iteration each is counted.
    pub loops: u64,
}

impl Work {
    /// Counts `entry` of a linked program; zero if it has no such entry point.
    pub fn of(linked: &Linked, entry: &str) -> Self {
        let module = &linked.module;
        let entries = module.entry_points.iter().enumerate();
        let Some((index, found)) = entries.clone().find(|(_, found)| found.name == entry) else {
            return Self::default();
        };
        // naga lists a function after those that it calls.
        let mut called: Vec<Self> = Vec::new();
        for (handle, function) in module.functions.iter() {
            let info = &linked.info[handle];
            let work = Counter {
                module,
                info,
                expressions: &function.expressions,
                called: &called,
            }
            .block(&function.body);
            called.push(work);
        }
        let counter = Counter {
            module,
            info: linked.info.get_entry_point(index),
            expressions: &found.function.expressions,
            called: &called,
        };
        counter.block(&found.function.body)
    }

    /// Bytes read and written.
    pub fn bytes(&self) -> u64 {
        self.read + self.written
    }

    fn and(self, other: Self) -> Self {
        Self {
            flops: self.flops + other.flops,
            read: self.read + other.read,
            written: self.written + other.written,
            loops: self.loops + other.loops,
        }
    }

    /// The more expensive of two branches, if an operation costs as much as a byte.
    fn or(self, other: Self) -> Self {
        let cost = |work: Self| work.flops + work.bytes();
        if cost(other) > cost(self) {
            other
        } else {
            self
        }
    }
}

/// Counter for a function.
struct Counter<'a> {
    module: &'a Module,
    info: &'a FunctionInfo,
    expressions: &'a naga::Arena<Expression>,
    called: &'a [Work],
}

impl Counter<'_> {
    fn block(&self, block: &Block) -> Work {
        let each = block.iter().map(|statement| self.statement(statement));
        each.fold(Work::default(), Work::and)
    }

    fn statement(&self, statement: &Statement) -> Work {
        match statement {
            Statement::Emit(range) => {
                let each = range.clone().map(|expression| self.expression(expression));
                each.fold(Work::default(), Work::and)
            }
            Statement::Block(block) => self.block(block),
            Statement::If { accept, reject, .. } => self.block(accept).or(self.block(reject)),
            Statement::Switch { cases, .. } => {
                let each = cases.iter().map(|case| self.block(&case.body));
                each.fold(Work::default(), Work::or)
            }
            Statement::Loop {
                body, continuing, ..
            } => {
                let turn = self.block(body).and(self.block(continuing));
                Work {
                    loops: turn.loops + 1,
                    ..turn
                }
            }
            Statement::Store { pointer, .. } => Work {
                written: self.stored_bytes(*pointer),
                ..Work::default()
            },
            // Read, and written back.
            Statement::Atomic { pointer, .. } => Work {
                read: self.stored_bytes(*pointer),
                written: self.stored_bytes(*pointer),
                ..Work::default()
            },
            Statement::Call { function, .. } => self.called[function.index()],
            _ => Work::default(),
        }
    }

    fn expression(&self, at: Handle<Expression>) -> Work {
        let flops = |flops| Work {
            flops,
            ..Work::default()
        };
        match &self.expressions[at] {
            Expression::Load { pointer } => Work {
                read: self.stored_bytes(*pointer),
                ..Work::default()
            },
            Expression::Binary { op, left, right } => match op {
                BinaryOperator::Add | BinaryOperator::Subtract | BinaryOperator::Divide => {
                    flops(self.floats(at))
                }
                BinaryOperator::Multiply => flops(self.product([*left, *right], at)),
                _ => Work::default(),
            },
            Expression::Math { fun, arg, .. } => {
                let [wide, result] = [*arg, at].map(|of| self.floats(of));
                flops(match fun {
                    MathFunction::Min
                    | MathFunction::Max
                    | MathFunction::Sqrt
                    | MathFunction::InverseSqrt
                    | MathFunction::Exp
                    | MathFunction::Exp2
                    | MathFunction::Log
                    | MathFunction::Log2
                    | MathFunction::Pow
                    | MathFunction::Sin
                    | MathFunction::Cos => result,
                    MathFunction::Fma | MathFunction::Clamp => 2 * result,
                    MathFunction::Mix => 3 * result,
                    MathFunction::Dot => (2 * wide).saturating_sub(1),
                    MathFunction::Cross => 3 * result,
                    MathFunction::Length => 2 * wide,
                    MathFunction::Distance | MathFunction::Normalize => 3 * wide,
                    _ => 0,
                })
            }
            _ => Work::default(),
        }
    }

    /// Operations of a product: one per component; a matrix times a vector is a sum of products per component.
    fn product(&self, factors: [Handle<Expression>; 2], at: Handle<Expression>) -> u64 {
        let inner = |of: Handle<Expression>| self.info[of].ty.inner_with(&self.module.types);
        let [left, right] = factors.map(inner);
        match (left, right) {
            (TypeInner::Matrix { columns, rows, .. }, TypeInner::Vector { .. })
            | (TypeInner::Vector { .. }, TypeInner::Matrix { columns, rows, .. }) => {
                2 * *columns as u64 * *rows as u64 - self.floats(at)
            }
            (
                TypeInner::Matrix { columns, rows, .. },
                TypeInner::Matrix {
                    columns: others, ..
                },
            ) => (2 * *columns as u64 - 1) * *rows as u64 * *others as u64,
            _ => self.floats(at),
        }
    }

    /// Components that are f32.
    fn floats(&self, of: Handle<Expression>) -> u64 {
        match self.info[of].ty.inner_with(&self.module.types) {
            TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => 1,
            TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => *size as u64,
            TypeInner::Matrix { columns, rows, .. } => *columns as u64 * *rows as u64,
            _ => 0,
        }
    }

    /// Bytes behind a pointer into a storage buffer; zero elsewhere.
    fn stored_bytes(&self, pointer: Handle<Expression>) -> u64 {
        let inner = self.info[pointer].ty.inner_with(&self.module.types);
        let Some(AddressSpace::Storage { .. }) = inner.pointer_space() else {
            return 0;
        };
        let base = inner.pointer_base_type();
        let size = base.and_then(|base| {
            base.inner_with(&self.module.types)
                .try_size(self.module.to_ctx())
        });
        size.map_or(0, u64::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use riprap::{
        gpu::link::Program,
        lattice::{BrickKind, Collision, Force, Setup, Storage, bytes_per_cell, collide_stream},
    };

    fn work(body: &str) -> Work {
        let text = format!(
            "@group(0) @binding(0) var<storage, read> a: array<vec4f>;\n\
             @group(0) @binding(1) var<storage, read_write> b: array<f32>;\n\
             @group(0) @binding(2) var<storage, read_write> n: array<atomic<u32>>;\n\
             fn twice(x: f32) -> f32 {{ return x + x; }}\n\
             @compute @workgroup_size(64) fn it(@builtin(global_invocation_id) at: vec3u) {{\n\
             let k = at.x;\n{body}\n}}\n"
        );
        let linked = Program::new("it").text("it", text).link().unwrap();
        Work::of(&linked, "it")
    }

    fn counted(flops: u64, read: u64, written: u64, loops: u64) -> Work {
        Work {
            flops,
            read,
            written,
            loops,
        }
    }

    #[test]
    fn operations_are_of_components() {
        // 4 products, 3 sums, a sum, and a call.
        let found = work("b[k] = twice(dot(a[k], a[k + 1u]) + 1.0);");
        assert_eq!(found, counted(7 + 1 + 1, 32, 4, 0));
        let found = work("let v = sqrt(max(a[k] * 2.0, vec4f(0.0))) / 3.0; b[k] = -v.x;");
        assert_eq!(found, counted(4 * 4, 16, 4, 0));
        let found = work("let m = mat2x3f(); let v = m * vec2f(b[k], 1.0); b[k] = v.x;");
        // Three sums of two products.
        assert_eq!(found, counted(9, 4, 4, 0));
        // Integer operations do not count; an atomic addition reads and writes its word.
        assert_eq!(work("atomicAdd(&n[k * 3u + 1u], 2u);"), counted(0, 4, 4, 0));
    }

    #[test]
    fn the_dearer_branch_and_one_turn_count() {
        let found =
            work("if (k > 7u) { return; } if (k > 3u) { b[k] = b[k] + 1.0; } else { b[k] = 0.0; }");
        assert_eq!(found, counted(1, 4, 4, 0));
        let found =
            work("var s = 0.0; for (var i = 0u; i < k; i++) { s += b[i] * 2.0; } b[k] = s;");
        assert_eq!(found, counted(2, 4, 4, 1));
        let found = work(
            "switch k { case 0u: { b[k] = 1.0; } case 1u: { b[k] = b[1] * 2.0; } default: {} }",
        );
        assert_eq!(found, counted(1, 4, 4, 0));
    }

    /// Storage, cells per invocation, and whether words have 64 bits.
    const LAYOUTS: [(Storage, u32, bool); 6] = [
        (Storage::F32, 1, false),
        (Storage::F32, 4, false),
        (Storage::F32, 4, true),
        (Storage::F16, 2, false),
        (Storage::F16, 4, false),
        (Storage::F16, 4, true),
    ];

    fn step(setup: &Setup) -> Work {
        let linked = collide_stream(setup, 1, BrickKind::All).link().unwrap();
        Work::of(&linked, "collide_stream")
    }

    fn setup((storage, lanes, wide): (Storage, u32, bool)) -> Setup {
        let mut setup = Setup::periodic([8; 3], 0.1);
        (setup.storage, setup.lanes, setup.wide) = (storage, lanes, wide);
        setup.max_speed = 0.0;
        setup
    }

    #[test]
    fn the_plain_step_moves_its_populations_and_nothing_else() {
        for layout in LAYOUTS {
            let setup = setup(layout);
            let found = step(&setup);
            let cells = u64::from(setup.lanes);
            assert_eq!(found.loops, 0, "{layout:?}");
            assert_eq!(found.read, found.written, "{layout:?}");
            assert_eq!(found.bytes(), cells * bytes_per_cell(&setup), "{layout:?}");
        }
    }

    /// The arithmetic of a cell is the same in every lane.
    #[test]
    fn a_cell_takes_as_many_operations_in_any_number_of_lanes() {
        for collision in [Collision::Bgk, Collision::Hermite, Collision::Suga] {
            let flops = |lanes| {
                let mut setup = setup((Storage::F32, lanes, false));
                setup.collision = collision;
                step(&setup).flops as f64 / f64::from(lanes)
            };
            // What does not depend on the cell is computed once per invocation.
            let (one, four) = (flops(1), flops(4));
            assert!(
                (one - four).abs() < 0.02 * one,
                "{collision:?}: {one}, {four}"
            );
        }
    }

    #[test]
    fn what_a_setup_adds_costs_operations_or_bytes() {
        let plain = setup((Storage::F32, 1, false));
        let more = |change: fn(&mut Setup)| {
            let mut setup = plain.clone();
            change(&mut setup);
            let [with, without] = [&setup, &plain].map(step);
            let flops = with.flops as i64 - without.flops as i64;
            [flops, with.bytes() as i64 - without.bytes() as i64]
        };
        let [flops, bytes] = more(|s| s.force = Force::Constant([1e-6, 0.0, 0.0]));
        assert!(flops > 0 && bytes == 0, "{flops} {bytes}");
        let [flops, bytes] = more(|s| s.force = Force::Field(vec![[0.0; 3]; 512]));
        // As often as the code reads it.
        assert!(
            flops > 0 && bytes >= 12 && bytes % 12 == 0,
            "{flops} {bytes}"
        );
        // Its own velocity is written, and those of six neighbours are read, each counted.
        let [flops, bytes] = more(|s| s.wale = Some(0.5));
        assert!(flops > 20 && bytes >= 24, "{flops} {bytes}");
        let [flops, bytes] = more(|s| s.collision = Collision::Bgk);
        assert!(flops < 0 && bytes == 0, "{flops} {bytes}");
    }
}
