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
    COMPOSER.with_borrow_mut(|composer| compose(composer, modules(), &ENGINE, source, definitions))
}

/// As [`module_with`], for functions that read bindings: uniforms, the view, the lights and the
/// results of the engine's functions are variables that `source` sets, see [`engine`].
pub fn module_alone(
    source: &str,
    definitions: &[Definition],
) -> Result<wgpu::naga::Module, String> {
    static MODULES: OnceLock<Modules> = OnceLock::new();
    let modules = MODULES.get_or_init(|| {
        let modules = modules().iter();
        modules
            .map(|(name, (text, imports))| {
                (name.clone(), (without_bindings(text), imports.clone()))
            })
            .collect()
    });
    thread_local! {
        static COMPOSER: RefCell<Composer> = RefCell::default();
    }
    COMPOSER.with_borrow_mut(|composer| {
        compose(composer, modules, &engine::MODULES, source, definitions)
    })
}

/// The text with uniforms as private variables.
fn without_bindings(text: &str) -> String {
    let line = |line: &str| match line.split_once("var<uniform>") {
        Some((_, after)) => format!("var<private>{after}\n"),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// The text of a fragment shader with its entry point as a plain function, which others can call.
pub fn without_stage(text: &str) -> String {
    let attributes = [
        "@fragment",
        "@builtin(position) ",
        "@location(0) ",
        "@location(1) ",
    ];
    (attributes.iter()).fold(text.to_owned(), |text, attribute| {
        text.replace(*attribute, "")
    })
}

/// Composes a module, and keeps it for `tools/translate`.
fn compose(
    composer: &mut Composer,
    modules: &Modules,
    engine: &[(&str, &str)],
    source: &str,
    definitions: &[Definition],
) -> Result<wgpu::naga::Module, String> {
    let module = composed(composer, modules, engine, source, definitions)?;
    keep(&module, definitions);
    Ok(module)
}

fn composed(
    composer: &mut Composer,
    modules: &Modules,
    engine: &[(&str, &str)],
    source: &str,
    definitions: &[Definition],
) -> Result<wgpu::naga::Module, String> {
    composer.capabilities = wgpu::naga::valid::Capabilities::all();
    let (_, wanted, _) = get_preprocessor_data(source);
    for import in wanted {
        add(composer, modules, engine, &import.import)?;
    }
    let mut shader_defs: HashMap<_, _> = definitions
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

/// Writes a composed shader into the folder that the variable `WGSL_OUT` names, if there is one, for
/// `tools/translate`.
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

/// The crate's modules with the engine's own, for materials.
pub struct Library {
    composer: Composer,
    engine: HashMap<String, (String, HashMap<String, ShaderDefValue>)>,
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
        self.composer.capabilities = wgpu::naga::valid::Capabilities::all();
        self.add_imports(source)?;
        compose(&mut self.composer, modules(), &[], source, definitions).map(|_| ())
    }

    /// The same of an entry point that only some native devices can have: it is not translated.
    pub fn check(&mut self, source: &str, definitions: &[Definition]) -> Result<(), String> {
        self.composer.capabilities = wgpu::naga::valid::Capabilities::all();
        self.add_imports(source)?;
        composed(&mut self.composer, modules(), &[], source, definitions).map(|_| ())
    }

    fn add_imports(&mut self, text: &str) -> Result<(), String> {
        let (_, imports, _) = get_preprocessor_data(text);
        for name in imports.into_iter().map(|import| import.import) {
            if self.composer.contains_module(&name) {
                continue;
            }
            let none = HashMap::new();
            let own = modules().get(&name).map(|(text, _)| (text.clone(), none));
            let (text, definitions) = own
                .or_else(|| self.engine.get(&name).cloned())
                .ok_or_else(|| format!("no module {name:?}"))?;
            self.add_imports(&text)?;
            add_module(&mut self.composer, &name, &text, &definitions)?;
        }
        Ok(())
    }
}

type Modules = HashMap<String, (String, Vec<naga_oil::compose::ImportDefinition>)>;

/// What can be imported: text and imports by name.
fn modules() -> &'static Modules {
    static MODULES: OnceLock<Modules> = OnceLock::new();
    MODULES.get_or_init(|| {
        let mut modules = HashMap::new();
        for path in files() {
            let text = fs::read_to_string(&path).expect("a WGSL file");
            let (name, imports, _) = get_preprocessor_data(&text);
            if let Some(name) = name {
                modules.insert(name, (text, imports));
            }
        }
        modules
    })
}

fn add(
    composer: &mut Composer,
    modules: &Modules,
    engine: &[(&str, &str)],
    name: &str,
) -> Result<(), String> {
    if composer.contains_module(name) {
        return Ok(());
    }
    if let Some((_, text)) = engine.iter().find(|(engine, _)| *engine == name) {
        let (_, imports, _) = get_preprocessor_data(text);
        for import in imports {
            add(composer, modules, engine, &import.import)?;
        }
        return add_module(composer, name, text, &HashMap::new());
    }
    let (text, imports) = modules
        .get(name)
        .ok_or_else(|| format!("no module {name:?} in the crate"))?;
    for import in imports {
        add(composer, modules, engine, &import.import)?;
    }
    add_module(composer, name, text, &HashMap::new())
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

fn add_module(
    composer: &mut Composer,
    name: &str,
    text: &str,
    shader_defs: &HashMap<String, ShaderDefValue>,
) -> Result<(), String> {
    composer
        .add_composable_module(ComposableModuleDescriptor {
            source: text,
            file_path: name,
            shader_defs: shader_defs.clone(),
            ..Default::default()
        })
        .map(|_| ())
        .map_err(|error| error.emit_to_string(composer))
}
