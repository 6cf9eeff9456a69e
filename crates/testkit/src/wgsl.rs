//! The shipped WGSL, composed as the engine composes it.

use std::{
    cell::RefCell,
    collections::HashMap,
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    path::{Path, PathBuf},
    sync::OnceLock,
};

use bevy::shader::{Shader, ShaderDefVal, ShaderImport, Source};
use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue,
    get_preprocessor_data,
};

use crate::{ROOT, engine};

/// Every WGSL file of the crate.
pub fn files() -> Vec<PathBuf> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of the crate") {
            let path = entry.expect("entry").path();
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|e| e == "wgsl") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    walk(&Path::new(ROOT).join("src"), &mut found);
    found.sort();
    found
}

/// A shader definition: a flag, or a number.
pub type Definition<'a> = (&'a str, Option<u32>);

/// Composes an entry point: `source` may import every module of the crate.
pub fn module(source: &str, flags: &[&str]) -> Result<wgpu::naga::Module, String> {
    let definitions: Vec<Definition> = flags.iter().map(|flag| (*flag, None)).collect();
    module_with(source, &definitions)
}

/// As [`module`], with numbers among the definitions.
pub fn module_with(source: &str, definitions: &[Definition]) -> Result<wgpu::naga::Module, String> {
    // Modules are the same for every entry point: each thread parses them once.
    thread_local! {
        static COMPOSER: RefCell<Composer> = RefCell::default();
    }
    let find = |name: &str| text_of(&ENGINE, name).or_else(|| modules().get(name).cloned());
    let find = |name: &str| Some((find(name)?, HashMap::new()));
    COMPOSER.with_borrow_mut(|composer| compose(composer, &find, source, definitions))
}

/// As [`module_with`], for functions that read bindings: uniforms, the view, the lights and the
/// results of the engine's functions are variables that `source` sets, see [`engine`].
pub fn module_alone(
    source: &str,
    definitions: &[Definition],
) -> Result<wgpu::naga::Module, String> {
    thread_local! {
        static COMPOSER: RefCell<Composer> = RefCell::default();
    }
    let own = |name: &str| modules().get(name).map(|text| without_bindings(text));
    let find = |name: &str| text_of(&engine::MODULES, name).or_else(|| own(name));
    let find = |name: &str| Some((find(name)?, HashMap::new()));
    COMPOSER.with_borrow_mut(|composer| compose(composer, &find, source, definitions))
}

fn text_of(engine: &[(&str, &str)], name: &str) -> Option<String> {
    let module = engine.iter().find(|(known, _)| *known == name);
    module.map(|(_, text)| (*text).to_owned())
}

/// The text with uniforms as private variables.
fn without_bindings(text: &str) -> String {
    let line = |line: &str| match line.split_once("var<uniform>") {
        Some((_, after)) => format!("var<private>{after}\n"),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// The values of definitions by name.
type Values = HashMap<String, ShaderDefValue>;

/// The text of a module that can be imported, and what is defined in it.
type Find<'a> = &'a dyn Fn(&str) -> Option<(String, Values)>;

/// Composes a module, and keeps it for `tools/translate`.
fn compose(
    composer: &mut Composer,
    find: Find,
    source: &str,
    definitions: &[Definition],
) -> Result<wgpu::naga::Module, String> {
    let module = composed(composer, find, source, definitions)?;
    keep(&module, definitions);
    Ok(module)
}

fn composed(
    composer: &mut Composer,
    find: Find,
    source: &str,
    definitions: &[Definition],
) -> Result<wgpu::naga::Module, String> {
    composer.capabilities = wgpu::naga::valid::Capabilities::all();
    add_imports(composer, find, source)?;
    let mut shader_defs: Values = definitions
        .iter()
        .map(|(name, number)| {
            let value = number.map_or(ShaderDefValue::Bool(true), ShaderDefValue::UInt);
            ((*name).to_owned(), value)
        })
        .collect();
    // Its value is the only difference between views with 2, 4 and 8 samples.
    shader_defs
        .entry("SAMPLES".to_owned())
        .or_insert(ShaderDefValue::UInt(4));
    composer
        .make_naga_module(NagaModuleDescriptor {
            source,
            file_path: "entry.wgsl",
            shader_defs,
            ..Default::default()
        })
        .map_err(|error| error.emit_to_string(composer))
}

/// A composed shader as WGSL text, which is what browsers get.
pub fn written(module: &wgpu::naga::Module) -> String {
    use wgpu::naga::{
        back::wgsl::{WriterFlags, write_string},
        valid::{Capabilities, ValidationFlags, Validator},
    };
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(module).expect("composed as valid");
    write_string(module, &info, WriterFlags::empty()).expect("valid")
}

/// Whether a text is a valid shader.
///
/// # Errors
/// What is wrong with it.
pub fn check(text: &str) -> Result<(), String> {
    use wgpu::naga::{
        front::wgsl::parse_str,
        valid::{Capabilities, ValidationFlags, Validator},
    };
    let module = parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let valid = validator.validate(&module);
    valid
        .map(|_| ())
        .map_err(|error| format!("{:?}", error.as_inner()))
}

/// Writes a composed shader into the folder that the variable `WGSL_OUT` names, if there is one,
/// for `tools/translate`.
fn keep(module: &wgpu::naga::Module, definitions: &[Definition]) {
    let Some(folder) = std::env::var_os("WGSL_OUT") else {
        return;
    };
    let text = written(module);
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    let path = Path::new(&folder).join(format!("{:016x}.wgsl", hasher.finish()));
    if !path.exists() {
        fs::write(path, format!("// {definitions:?}\n{text}"))
            .expect("a folder that can be written");
    }
}

/// Adds the modules that a text imports, and those that these import.
fn add_imports(composer: &mut Composer, find: Find, text: &str) -> Result<(), String> {
    let (_, imports, _) = get_preprocessor_data(text);
    for name in imports.into_iter().map(|import| import.import) {
        if composer.contains_module(&name) {
            continue;
        }
        let (text, shader_defs) = find(&name).ok_or_else(|| format!("no module {name:?}"))?;
        add_imports(composer, find, &text)?;
        let module = ComposableModuleDescriptor {
            source: &text,
            file_path: &name,
            shader_defs,
            ..Default::default()
        };
        let added = composer.add_composable_module(module).map(|_| ());
        added.map_err(|error| error.emit_to_string(composer))?;
    }
    Ok(())
}

/// The crate's modules with the engine's own, for materials.
pub struct Library {
    composer: Composer,
    engine: HashMap<String, (String, Values)>,
}

impl Library {
    /// `shaders`: those that the engine has loaded.
    pub fn new<'a>(shaders: impl Iterator<Item = &'a Shader>) -> Self {
        let module = |shader: &Shader| {
            let ShaderImport::Custom(name) = &shader.import_path else {
                return None;
            };
            let Source::Wgsl(text) = &shader.source else {
                return None;
            };
            let definitions = shader
                .shader_defs
                .iter()
                .map(|definition| match definition {
                    ShaderDefVal::Bool(name, value) => (name.clone(), ShaderDefValue::Bool(*value)),
                    ShaderDefVal::Int(name, value) => (name.clone(), ShaderDefValue::Int(*value)),
                    ShaderDefVal::UInt(name, value) => (name.clone(), ShaderDefValue::UInt(*value)),
                });
            Some((name.clone(), (text.to_string(), definitions.collect())))
        };
        Self {
            composer: Composer::default(),
            engine: shaders.filter_map(module).collect(),
        }
    }

    /// Composes and validates an entry point.
    pub fn compose(&mut self, source: &str, definitions: &[Definition]) -> Result<(), String> {
        let module = self.module(source, definitions)?;
        keep(&module, definitions);
        Ok(())
    }

    /// The same of an entry point that only some native devices can have: it is not translated.
    pub fn check(&mut self, source: &str, definitions: &[Definition]) -> Result<(), String> {
        self.module(source, definitions).map(|_| ())
    }

    fn module(
        &mut self,
        source: &str,
        definitions: &[Definition],
    ) -> Result<wgpu::naga::Module, String> {
        let Self { composer, engine } = self;
        let own = |name: &str| Some((modules().get(name)?.clone(), HashMap::new()));
        let find = |name: &str| own(name).or_else(|| engine.get(name).cloned());
        composed(composer, &find, source, definitions)
    }
}

/// The text of each module of the crate that can be imported, by name.
fn modules() -> &'static HashMap<String, String> {
    static MODULES: OnceLock<HashMap<String, String>> = OnceLock::new();
    MODULES.get_or_init(|| {
        let texts = files()
            .into_iter()
            .map(|path| fs::read_to_string(path).expect("a WGSL file"));
        let named = texts.filter_map(|text| Some((get_preprocessor_data(&text).0?, text)));
        named.collect()
    })
}

/// What the crate imports of the engine, as far as it uses it.
const ENGINE: [(&str, &str); 2] = [
    (
        "bevy_pbr::mesh_bindings",
        "#define_import_path bevy_pbr::mesh_bindings
         struct Mesh { world_from_local: mat3x4<f32> }
         @group(2) @binding(0) var<storage> mesh: array<Mesh>;",
    ),
    (
        "bevy_pbr::mesh_view_bindings",
        "#define_import_path bevy_pbr::mesh_view_bindings
         struct View {
             clip_from_world: mat4x4<f32>,
             clip_from_view: mat4x4<f32>,
             viewport: vec4<f32>,
         }
         @group(0) @binding(0) var<uniform> view: View;",
    ),
];
