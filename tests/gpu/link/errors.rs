//! Positions of errors, and that unrolled loops equal the loops.

use kit::assert_contains;
use riprap::{Error, gpu::link::Program};

/// The position of an error and its message.
fn place(program: Program) -> (String, u32, String) {
    match program.link().unwrap_err() {
        Error::Shader {
            file,
            line,
            message,
        } => (file, line, message),
        other => panic!("{other}"),
    }
}

#[test]
fn errors_are_where_the_text_was_written() {
    let entry = "// A kernel.\n// needs unrolled\n\n@compute @workgroup_size(1)\nfn main() {}\n";
    let program = |unrolled: &str| {
        Program::new("entry")
            .text("entry", entry)
            .text("unrolled", unrolled)
    };
    let right = "fn f() -> f32 {
    var s = 0.0;
    for (var q = 0u; q < 27u; q++) { // unroll
        s += f32(q);
    }
    return s;
}
";
    assert!(program(right).link().is_ok());
    // After a loop that was unrolled into 27 blocks, then inside of it.
    let (file, line, message) = place(program(&right.replace("return s;", "return s +;")));
    assert_eq!((file.as_str(), line), ("unrolled", 6), "{message}");
    let (file, line, message) = place(program(&right.replace("return s;", "return t;")));
    assert_eq!((file.as_str(), line), ("unrolled", 6), "{message}");
    let (file, line, message) = place(program(&right.replace("f32(q)", "g(q)")));
    assert_eq!((file.as_str(), line), ("unrolled", 4), "{message}");
    // Valid syntax, invalid types.
    let (file, line, message) = place(program("fn f() -> f32 {\n    return 1u;\n}\n"));
    assert_eq!(file, "unrolled", "{line}: {message}");
    // In the file of the entry point, after all others.
    let broken = entry.replace("fn main() {}", "fn main() {\n    h();\n}");
    let (file, line, message) = place(program("").text("entry", broken));
    assert_eq!((file.as_str(), line), ("entry", 6), "{message}");
}

#[test]
fn what_is_missing_is_named_where_it_is_needed() {
    let program = |text: &str| Program::new("entry").text("entry", text);
    let (file, line, message) = place(program("// First.\n// needs grid, $eddy\n"));
    assert_eq!((file.as_str(), line), ("grid", 3), "{message}");
    assert_contains(&message, &["$lanes", "Program::slot"]);
    let (file, line, message) = place(program("// First.\n// needs velocities\n"));
    assert_eq!((file.as_str(), line), ("entry", 2), "{message}");
    assert!(message.contains("velocities"), "{message}");
    let (file, line, message) = place(Program::new("nothing"));
    assert_eq!((file.as_str(), line), ("nothing", 1), "{message}");
    let (_, _, message) = place(program("// needs $eddy").slot("eddy", "eddy_smagorinsky"));
    assert!(message.contains("eddy_smagorinsky"), "{message}");
}

#[test]
fn loops_to_unroll_are_closed_and_have_literal_bounds() {
    let program = |text: &str| Program::new("entry").text("entry", text);
    let open = "fn f() {\n    for (var q = 0u; q < 3u; q++) { // unroll\n    f();\n";
    let (file, line, message) = place(program(open));
    assert_eq!((file.as_str(), line), ("entry", 2), "{message}");
    assert!(message.contains("does not end"), "{message}");
    let bound = "fn f() {\n    for (var q = 0u; q < N; q++) { // unroll\n    }\n}\n";
    let (file, line, message) = place(program(bound));
    assert_eq!((file.as_str(), line), ("entry", 2), "{message}");
    assert!(message.contains("0u; q < 27u"), "{message}");
}

/// Nested loops, steps, and a counter whose name occurs in other identifiers and as a component.
#[test]
fn unrolled_loops_are_the_loops() {
    let text = "fn f(u: vec4<f32>, qq: u32) -> u32 {
    var sum = 0u;
    for (var q = 1u; q < 6u; q += 2u) { // unroll
        for (var k = 0u; k < 2u; k++) { // unroll
            sum += q * k + qq;
        }
    }
    return sum;
}
";
    let linked = Program::new("f").text("f", text).link().unwrap();
    let turns: Vec<_> = linked
        .text
        .lines()
        .filter(|line| line.contains("sum +="))
        .collect();
    let expected: Vec<_> = [1, 3, 5]
        .iter()
        .flat_map(|q| [0, 1].map(|k| format!("sum += {q}u * {k}u + qq;")))
        .collect();
    let found: Vec<_> = turns.iter().map(|line| line.trim().to_owned()).collect();
    assert_eq!(found, expected);
}
