//! A compute kernel on the caller's device, bound by name and recorded into the caller's pass.

use crate::{Error, Result, gpu::link::Linked};
use std::{borrow::Cow, sync::Arc};

/// A pipeline with the names of its bindings.
#[derive(Debug)]
pub struct Kernel {
    entry: String,
    linked: Arc<Linked>,
    slots: Vec<(String, String)>,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    bindings: Vec<Binding>,
    size: [u32; 3],
}

/// A storage or uniform buffer that a kernel needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Name of the variable in WGSL.
    pub name: String,
    /// `@binding` number, in group 0.
    pub number: u32,
    /// Binding type: uniform, read-only storage or storage.
    pub kind: wgpu::BufferBindingType,
}

/// A linked program on a device. Its kernels share one shader module.
#[derive(Debug)]
pub struct Shader {
    linked: Arc<Linked>,
    module: wgpu::ShaderModule,
}

impl Shader {
    /// Creates the shader module of a linked program.
    pub fn new(device: &wgpu::Device, linked: Linked) -> Self {
        Self {
            module: shader_module(device, &linked),
            linked: Arc::new(linked),
        }
    }

    /// Compiles `entry`, like [`Kernel::new`].
    ///
    /// # Errors
    /// Returns the errors of [`Kernel::new`].
    pub fn kernel(
        &self,
        device: &wgpu::Device,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> Result<Kernel> {
        compile(device, &self.linked, &self.module, entry, constants)
    }

    /// The linked program.
    pub fn linked(&self) -> &Linked {
        &self.linked
    }
}

/// Passes the naga module to wgpu, which therefore does not parse the text again.
fn shader_module(device: &wgpu::Device, linked: &Linked) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(&linked.file),
        source: wgpu::ShaderSource::Naga(Cow::Owned((*linked.module).clone())),
    })
}

impl Kernel {
    /// Compiles `entry` of a linked program. `constants` sets its WGSL overrides. It must contain every override that the
    /// program declares, except those with a default, and no others.
    ///
    /// # Errors
    /// [`Error::Limit`] if the device allows fewer bindings or smaller workgroups,
    /// [`Error::Shader`] if there is no such entry point, [`Error::Binding`] if a constant is not declared, is missing,
    /// or has a value that a 32-bit number cannot represent.
    pub fn new(
        device: &wgpu::Device,
        linked: &Linked,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> Result<Self> {
        let module = shader_module(device, linked);
        compile(device, &Arc::new(linked.clone()), &module, entry, constants)
    }

    /// Name of the entry point.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// File name of the entry point, without folder and extension.
    pub fn file(&self) -> &str {
        &self.linked.file
    }

    /// The slots of the program and the files that fill them.
    pub fn slots(&self) -> &[(String, String)] {
        &self.slots
    }

    /// Invocations per workgroup.
    pub fn invocations(&self) -> u32 {
        self.size.iter().product()
    }

    /// The program that contains the entry point.
    pub fn linked(&self) -> &Linked {
        &self.linked
    }

    /// Required bindings, in the order of their numbers.
    pub fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    /// Binds whole buffers by their WGSL names. Names that the kernel does not use are ignored, so that one list serves all
    /// variants of a kernel.
    ///
    /// # Errors
    /// [`Error::Binding`] if a buffer is missing.
    pub fn bind(
        &self,
        device: &wgpu::Device,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<wgpu::BindGroup> {
        let entries = self
            .bindings
            .iter()
            .map(|b| {
                let named = buffers.iter().find(|(name, _)| *name == b.name);
                let (_, buffer) = named.ok_or_else(|| Error::Binding {
                    kernel: self.entry.clone(),
                    binding: b.name.clone(),
                    message: "no buffer was given under this name".into(),
                })?;
                Ok(wgpu::BindGroupEntry {
                    binding: b.number,
                    resource: buffer.as_entire_binding(),
                })
            })
            .collect::<Result<Vec<_>>>()?;
        Ok(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.entry),
            layout: &self.layout,
            entries: &entries,
        }))
    }

    /// Records a dispatch of `groups` workgroups, folded into two dimensions if they exceed the limit of one. Kernels compute
    /// their index as `workgroup_id.x + workgroup_id.y * num_workgroups.x`.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, bind: &wgpu::BindGroup, groups: u32) {
        if groups == 0 {
            return;
        }
        self.record_grid(pass, bind, fold(groups));
    }

    /// Records a dispatch of x × y workgroups, for kernels that number them row by row.
    pub fn record_grid(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        bind: &wgpu::BindGroup,
        [x, y]: [u32; 2],
    ) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bind, &[]);
        pass.dispatch_workgroups(x, y, 1);
    }
}

fn compile(
    device: &wgpu::Device,
    linked: &Arc<Linked>,
    module: &wgpu::ShaderModule,
    entry: &str,
    constants: &[(&str, f64)],
) -> Result<Kernel> {
    check_constants(linked, entry, constants)?;
    let bindings = bindings(linked, entry)?;
    let storage = bindings
        .iter()
        .filter(|b| matches!(b.kind, wgpu::BufferBindingType::Storage { .. }))
        .count() as u64;
    let limits = device.limits();
    within(
        "storage buffers per shader stage",
        storage,
        limits.max_storage_buffers_per_shader_stage.into(),
    )?;
    // wgpu does not report a workgroup that is too large.
    let size = workgroup_size(linked, entry);
    within(
        "invocations per workgroup",
        size.iter().map(|&n| u64::from(n)).product(),
        limits.max_compute_invocations_per_workgroup.into(),
    )?;
    let entries: Vec<_> = bindings
        .iter()
        .map(|b| wgpu::BindGroupLayoutEntry {
            binding: b.number,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: b.kind,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(entry),
        entries: &entries,
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&pipeline_layout),
        module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants,
            zero_initialize_workgroup_memory: false,
        },
        cache: None,
    });
    Ok(Kernel {
        entry: entry.into(),
        linked: linked.clone(),
        slots: linked.slots.clone().into_iter().collect(),
        pipeline,
        layout,
        bindings,
        size,
    })
}

/// Bytes of the largest storage binding of a device, limited so that 32 bits can index its 4-byte words.
pub fn largest_binding(limits: &wgpu::Limits) -> u64 {
    let bytes = limits.max_storage_buffer_binding_size;
    bytes
        .min(limits.max_buffer_size)
        .min(4 * u64::from(u32::MAX))
}

/// Submits one compute pass with what `record` records, whatever it returns.
pub fn submit_pass<T>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    record: impl FnOnce(&mut wgpu::ComputePass<'_>) -> T,
) -> T {
    let mut encoder = device.create_command_encoder(&Default::default());
    let recorded = record(&mut encoder.begin_compute_pass(&Default::default()));
    queue.submit([encoder.finish()]);
    recorded
}

/// Workgroups per dimension that WebGPU guarantees.
pub const MAX_GROUPS: u32 = 65_535;

/// The smallest grid x × y of at least `groups` workgroups with both sides within [`MAX_GROUPS`].
pub fn fold(groups: u32) -> [u32; 2] {
    let y = groups.div_ceil(MAX_GROUPS);
    [groups.div_ceil(y.max(1)), y]
}

fn within(name: &str, wants: u64, has: u64) -> Result<()> {
    if wants <= has {
        return Ok(());
    }
    Err(Error::Limit {
        name: name.into(),
        wants,
        has,
        remedy: "request the device with the limits that Needs names, or use another adapter"
            .into(),
    })
}

/// Checks that `constants` are the constants that the program declares, and that 32 bits can represent their values.
fn check_constants(linked: &Linked, entry: &str, constants: &[(&str, f64)]) -> Result<()> {
    let refused = |name: &str, message: String| {
        Err(Error::Binding {
            kernel: entry.into(),
            binding: name.into(),
            message,
        })
    };
    for (name, value) in constants {
        if !linked.declares(name) {
            let message = "the kernel declares no such constant; check the spelling";
            return refused(name, message.into());
        }
        if !(*value as f32).is_finite() {
            let message = format!("its value {value} is not a 32-bit number; check the setup");
            return refused(name, message);
        }
    }
    let required = linked
        .module
        .overrides
        .iter()
        .filter(|(_, o)| o.init.is_none());
    for name in required.filter_map(|(_, o)| o.name.as_deref()) {
        if !constants.iter().any(|(given, _)| *given == name) {
            return refused(
                name,
                "the kernel declares this constant, and no value is given".into(),
            );
        }
    }
    Ok(())
}

/// The workgroup size of `entry`, in invocations; overrides have the values given in the text.
fn workgroup_size(linked: &Linked, entry: &str) -> [u32; 3] {
    let found = linked.module.entry_points.iter().find(|e| e.name == entry);
    found.map_or([1; 3], |e| e.workgroup_size)
}

/// The buffers of group 0 that `entry` uses, by binding number.
///
/// # Errors
/// [`Error::Shader`] if there is no such entry point.
pub fn bindings(linked: &Linked, entry: &str) -> Result<Vec<Binding>> {
    let module = &linked.module;
    let index = module
        .entry_points
        .iter()
        .position(|e| e.name == entry)
        .ok_or_else(|| Error::Shader {
            file: entry.into(),
            line: 0,
            message: "no entry point has this name".into(),
        })?;
    let info = linked.info.get_entry_point(index);
    let mut found: Vec<Binding> = module
        .global_variables
        .iter()
        .filter(|(handle, _)| !info[*handle].is_empty())
        .filter_map(|(_, variable)| {
            let kind = match variable.space {
                naga::AddressSpace::Uniform => wgpu::BufferBindingType::Uniform,
                naga::AddressSpace::Storage { access } => wgpu::BufferBindingType::Storage {
                    read_only: !access.contains(naga::StorageAccess::STORE),
                },
                _ => return None,
            };
            Some(Binding {
                name: variable.name.clone()?,
                number: variable.binding.as_ref()?.binding,
                kind,
            })
        })
        .collect();
    found.sort_by_key(|b| b.number);
    Ok(found)
}
