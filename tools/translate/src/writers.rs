//! Writers of naga, and the tools that check what they write.

use std::{fs, path::Path, process::Command};

use naga::{
    ShaderStage,
    back::{glsl, hlsl, msl, spv},
    proc::BoundsCheckPolicies,
};

use crate::Shader;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Language {
    /// Vulkan.
    SpirV,
    /// Metal.
    Msl,
    /// Direct3D 12, shader model 5.1.
    Hlsl,
    /// OpenGL ES 3.1.
    GlslEs,
}

impl Language {
    pub const ALL: [Self; 4] = [Self::SpirV, Self::Msl, Self::Hlsl, Self::GlslEs];

    pub fn name(self) -> &'static str {
        match self {
            Self::SpirV => "SPIR-V",
            Self::Msl => "MSL",
            Self::Hlsl => "HLSL",
            Self::GlslEs => "GLSL ES 3.10",
        }
    }
}

/// Whether a failure is of a language that lacks what the shader uses. OpenGL ES 3.1 cannot ask for the
/// number of levels of a texture, so tonal art maps are not for it; nor can it load from depth textures, as
/// the engine's prepass is in materials; nor has it arrays of bindings, as materials without bind groups use
/// where the adapter has them.
pub fn is_known_gap(what: &str) -> bool {
    what.starts_with(Language::GlslEs.name())
        && (what.contains("MissingFeatures(Features(TEXTURE_LEVELS")
            || what.contains("`textureLoad` from depth textures")
            || what.contains(BINDING_ARRAYS))
}

/// naga's writer of GLSL panics on these.
const BINDING_ARRAYS: &str = "arrays of bindings";

fn has_binding_arrays(module: &naga::Module) -> bool {
    module.global_variables.iter().any(|(_, variable)| {
        matches!(
            module.types[variable.ty].inner,
            naga::TypeInner::BindingArray { .. }
        )
    })
}

/// Translates a shader, and checks the result. `scratch`: a path for files, without extension.
pub fn write(language: Language, shader: &Shader, scratch: &Path) -> Result<(), String> {
    match language {
        Language::SpirV => spirv(shader, scratch),
        Language::Msl => metal(shader),
        Language::Hlsl => direct3d(shader),
        Language::GlslEs => opengl(shader, scratch),
    }
}

/// Runs a tool. Its output, if it fails.
fn run(command: &mut Command) -> Result<(), String> {
    let output = command
        .output()
        .map_err(|error| format!("{command:?}: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let text = [output.stdout, output.stderr].concat();
    Err(String::from_utf8_lossy(&text).into_owned())
}

fn spirv(shader: &Shader, scratch: &Path) -> Result<(), String> {
    let options = spv::Options {
        lang_version: (1, 3),
        ..spv::Options::default()
    };
    let words = spv::write_vec(&shader.module, &shader.info, &options, None)
        .map_err(|error| error.to_string())?;
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let path = scratch.with_extension("spv");
    fs::write(&path, bytes).map_err(|error| error.to_string())?;
    run(Command::new("spirv-val")
        .args(["--target-env", "vulkan1.1"])
        .arg(path))
}

fn metal(shader: &Shader) -> Result<(), String> {
    let options = msl::Options {
        lang_version: (2, 3),
        ..msl::Options::default()
    };
    let pipeline = msl::PipelineOptions::default();
    let written = msl::write_string(&shader.module, &shader.info, &options, &pipeline);
    let (_, info) = written.map_err(|error| error.to_string())?;
    info.entry_point_names
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(|e| format!("{e:?}"))?;
    Ok(())
}

fn direct3d(shader: &Shader) -> Result<(), String> {
    let options = hlsl::Options::default();
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    let info = hlsl::Writer::new(&mut text, &options, &pipeline)
        .write(&shader.module, &shader.info, None)
        .map_err(|error| error.to_string())?;
    info.entry_point_names
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(|e| format!("{e:?}"))?;
    Ok(())
}

fn opengl(shader: &Shader, scratch: &Path) -> Result<(), String> {
    if has_binding_arrays(&shader.module) {
        return Err(BINDING_ARRAYS.into());
    }
    let options = glsl::Options::default();
    for entry in &shader.module.entry_points {
        let pipeline = glsl::PipelineOptions {
            shader_stage: entry.stage,
            entry_point: entry.name.clone(),
            multiview: None,
        };
        let stage = match entry.stage {
            ShaderStage::Vertex => "vert",
            ShaderStage::Fragment => "frag",
            _ => "comp",
        };
        let mut text = String::new();
        let policies = BoundsCheckPolicies::default();
        let writer = glsl::Writer::new(
            &mut text,
            &shader.module,
            &shader.info,
            &options,
            &pipeline,
            policies,
        );
        let written = writer.and_then(|mut writer| writer.write().map(|_| ()));
        written.map_err(|error| format!("{error:?} ({})", entry.name))?;
        let path = scratch.with_extension(format!("{}.{stage}", entry.name));
        fs::write(&path, text).map_err(|error| error.to_string())?;
        run(Command::new("glslangValidator")
            .args(["-S", stage])
            .arg(path))?;
    }
    Ok(())
}
