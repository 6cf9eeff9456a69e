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

/// What OpenGL ES 3.1, its writer in naga 29, or the validator of Debian 12 lacks.
const GAPS_OF_GLSL_ES: [&str; 5] = [
    // The number of levels of a texture: tonal art maps.
    "MissingFeatures(Features(TEXTURE_LEVELS",
    // Loads from depth textures: the engine's prepass in materials.
    "`textureLoad` from depth textures",
    // The engine's reading of shadow maps; the validator does not know the extension.
    "GL_EXT_texture_shadow_lod",
    // Samples one by one. Multisampled views are drawn without depth there.
    "SampleId",
    BINDING_ARRAYS,
];

/// Materials without bind groups use these where the adapter has them. naga's writer panics on
/// them.
const BINDING_ARRAYS: &str = "arrays of bindings";

/// Whether a failure is one of the known gaps of GLSL ES.
pub fn is_known_gap(what: &str) -> bool {
    what.starts_with(Language::GlslEs.name())
        && GAPS_OF_GLSL_ES.iter().any(|gap| what.contains(gap))
}

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
