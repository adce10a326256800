//! Linked kernels in the languages of drivers: Metal, HLSL, SPIR-V and OpenGL ES 3.1.
//!
//! A compiler may still reject what naga translates; a kernel that naga cannot translate runs on no device of that kind.

use naga::{
    Module, ShaderStage,
    back::{glsl, hlsl, msl, spv},
    proc::BoundsCheckPolicies,
    valid::ModuleInfo,
};
use riprap::gpu::link::Linked;
use std::collections::HashMap;

/// Metal 2.0, which macOS has had since 10.13.
const METAL: (u8, u8) = (2, 0);

/// Translates a kernel with the override values `numbers` to all languages; `wide` kernels use 64-bit integers.
pub fn translate(linked: &Linked, entry: &str, numbers: &HashMap<String, f64>, wide: bool) {
    let numbers = numbers.iter().map(|(name, n)| (name.clone(), *n)).collect();
    let stage = (ShaderStage::Compute, entry);
    let (module, info) = naga::back::pipeline_constants::process_overrides(
        &linked.module,
        &linked.info,
        Some(stage),
        &numbers,
    )
    .unwrap_or_else(|error| panic!("{entry}: {error}"));
    let hlsl = direct(&module, &info, entry, wide);
    // OpenGL ES has no 64-bit integers, and no adapter with OpenGL ES offers them.
    let long = hlsl.as_ref().is_ok_and(|text| text.contains("uint64_t"));
    assert!(wide || !long, "{entry} has 64 bits that nobody asked for");
    let gles = gles(&module, &info, entry);
    assert_eq!(gles.is_err(), long, "{entry} in GLSL ES: {gles:?}");
    for (language, written) in [
        ("MSL", metal(&module, &info, entry)),
        ("HLSL", hlsl.map(|text| text.len())),
        ("SPIR-V", vulkan(&module, &info, entry)),
    ] {
        let size = written.unwrap_or_else(|error| panic!("{entry} in {language}: {error}"));
        assert!(size > 0, "{entry} in {language}");
    }
}

/// Length of the translation.
type Written = Result<usize, String>;

fn metal(module: &Module, info: &ModuleInfo, entry: &str) -> Written {
    let options = msl::Options {
        lang_version: METAL,
        ..Default::default()
    };
    let pipeline = msl::PipelineOptions {
        entry_point: Some((ShaderStage::Compute, entry.into())),
        ..Default::default()
    };
    let (text, made) =
        msl::write_string(module, info, &options, &pipeline).map_err(|e| e.to_string())?;
    for name in made.entry_point_names {
        name.map_err(|e| e.to_string())?;
    }
    Ok(text.len())
}

fn direct(module: &Module, info: &ModuleInfo, entry: &str, wide: bool) -> Result<String, String> {
    // The compiler of Windows accepts shader model 5.1; 64 bits require DXC.
    let shader_model = match wide {
        true => hlsl::ShaderModel::V6_0,
        false => hlsl::ShaderModel::V5_1,
    };
    let options = hlsl::Options {
        shader_model,
        ..Default::default()
    };
    let pipeline = hlsl::PipelineOptions {
        entry_point: Some((ShaderStage::Compute, entry.into())),
    };
    let mut text = String::new();
    let made = hlsl::Writer::new(&mut text, &options, &pipeline)
        .write(module, info, None)
        .map_err(|e| e.to_string())?;
    for name in made.entry_point_names {
        name.map_err(|e| e.to_string())?;
    }
    Ok(text)
}

fn vulkan(module: &Module, info: &ModuleInfo, entry: &str) -> Written {
    let pipeline = spv::PipelineOptions {
        shader_stage: ShaderStage::Compute,
        entry_point: entry.into(),
    };
    let words = spv::write_vec(module, info, &spv::Options::default(), Some(&pipeline));
    Ok(words.map_err(|e| e.to_string())?.len())
}

fn gles(module: &Module, info: &ModuleInfo, entry: &str) -> Written {
    let options = glsl::Options {
        version: glsl::Version::new_gles(310),
        ..Default::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: ShaderStage::Compute,
        entry_point: entry.into(),
        multiview: None,
    };
    let mut text = String::new();
    let policies = BoundsCheckPolicies::default();
    glsl::Writer::new(&mut text, module, info, &options, &pipeline, policies)
        .and_then(|mut writer| writer.write())
        .map_err(|e| e.to_string())?;
    Ok(text.len())
}
