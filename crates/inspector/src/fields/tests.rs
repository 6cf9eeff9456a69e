mod games_effect;

use bevy::reflect::Typed;

use super::{super::tooltip::plain, *};
use bevy_comics::{
    BlackFlats, ComicStyle, Contours, DepthMapping, Outlines,
    depth::RangeSmoothing,
    effect::EffectRegistry,
    effects::DepthLayer,
    lines::{
        Creases, EdgeColor, EdgeStyle, LineBoil, LineColor, LineWeight, ObjectEdges, Silhouettes,
    },
};

/// Every type with settings, by its name in paths.
fn all_types() -> Vec<(&'static str, &'static TypeInfo)> {
    let mut all = vec![
        ("depth_map", DepthMap::type_info()),
        ("depth_map.mapping", DepthMapping::type_info()),
        ("depth_map.smoothing", RangeSmoothing::type_info()),
        ("outlines.silhouettes", Silhouettes::type_info()),
        ("outlines.creases", Creases::type_info()),
        ("outlines.creases.convex", EdgeStyle::type_info()),
        ("outlines.creases.convex.color", EdgeColor::type_info()),
        ("outlines.objects", ObjectEdges::type_info()),
        ("outlines.weight", LineWeight::type_info()),
        ("outlines.boil", LineBoil::type_info()),
        ("outlines.color", LineColor::type_info()),
        ("depth_layers.foreground", DepthLayer::type_info()),
    ];
    for effect in EffectRegistry::built_in().types() {
        all.push((effect.name, (effect.type_info)()));
    }
    all.extend(types_of_objects());
    all
}

/// The types of the page of a picked object.
fn types_of_objects() -> Vec<(&'static str, &'static TypeInfo)> {
    #[cfg_attr(
        not(any(feature = "toon", feature = "objects")),
        allow(unused_mut, reason = "there are no such types")
    )]
    let mut all = Vec::new();
    #[cfg(feature = "toon")]
    all.extend([
        ("light", bevy_comics::ToonLight::type_info()),
        ("light.ramp", bevy_comics::toon::Ramp::type_info()),
        (
            "light.ramp.stops.0",
            bevy_comics::toon::RampStop::type_info(),
        ),
        (
            "light.ramp.detail",
            bevy_comics::toon::RampDetail::type_info(),
        ),
        (
            "light.ramp.detail.axis",
            bevy_comics::toon::DetailAxis::type_info(),
        ),
        (
            "light.stylized_highlight",
            bevy_comics::toon::StylizedHighlight::type_info(),
        ),
        ("light.proxy", bevy_comics::toon::ShadingProxy::type_info()),
        (
            "light.proxy.shape",
            bevy_comics::toon::ProxyShape::type_info(),
        ),
        ("light.rim", bevy_comics::toon::Rim::type_info()),
        ("light.rim.width", bevy_comics::toon::RimWidth::type_info()),
    ]);
    #[cfg(feature = "objects")]
    all.extend([
        ("outline_style", bevy_comics::OutlineStyle::type_info()),
        (
            "outline_style.kinds",
            bevy_comics::objects::OutlineKinds::type_info(),
        ),
        ("no_outlines", bevy_comics::NoOutlines::type_info()),
        (
            "mesh_sections",
            bevy_comics::objects::MeshSections::type_info(),
        ),
    ]);
    all
}

fn fields(info: &'static TypeInfo) -> Vec<&'static NamedField> {
    match info {
        TypeInfo::Struct(info) => info.iter().collect(),
        TypeInfo::Enum(info) => info
            .iter()
            .filter_map(|variant| variant.as_struct_variant().ok())
            .flat_map(|variant| variant.iter())
            .collect(),
        _ => Vec::new(),
    }
}

/// Without a range a number has no slider, and without documentation a setting
/// has no tooltip.
#[test]
fn every_field_is_documented_and_every_number_has_a_range() {
    for (name, info) in all_types() {
        assert!(!fields(info).is_empty(), "{name} has settings");
        for field in fields(info) {
            let name = format!("{name}.{}", field.name());
            assert!(
                !plain(field.docs().unwrap_or_default()).is_empty(),
                "{name}"
            );
            let path = field.type_path();
            let kinds = ["f32", "u32", "Vec2", "Vec3", "vec::Vec<"];
            // A place in the world has no range.
            let is_place = name == "iso_lines.center";
            let is_number = kinds.iter().any(|t| path.contains(t)) && !is_place;
            assert_eq!(FieldRange::of(field).is_some(), is_number, "{name}: {path}");
        }
    }
}

/// The numbers of the sentence "Range a to b", without remarks in parentheses.
fn documented_range(docs: &str) -> Option<[f64; 2]> {
    let words = docs.split_whitespace().skip_while(|word| *word != "Range");
    let mut depth = 0;
    let mut numbers = words.skip(1).filter(|word| {
        let inside = depth > 0 || word.starts_with('(');
        depth += word.matches('(').count();
        depth -= word.matches(')').count().min(depth);
        !inside
    });
    let number = |word: &str| word.trim_end_matches([',', '.', ';', '°']).parse().ok();
    let least = number(numbers.next()?)?;
    (numbers.next()? == "to").then_some(())?;
    Some([least, number(numbers.next()?)?])
}

/// The range that clamps a number is the one that its documentation names.
#[test]
fn ranges_are_those_of_the_documentation() {
    let mut checked = 0;
    for (name, info) in all_types() {
        for field in fields(info) {
            let range = FieldRange::of(field);
            let documented = field.docs().and_then(documented_range);
            let (Some(range), Some(documented)) = (range, documented) else {
                continue;
            };
            let is_right = [range.min, range.max]
                .iter()
                .zip(documented)
                .all(|(found, said)| (found - said).abs() <= 1e-6 * said.abs());
            let field = field.name();
            assert!(is_right, "{name}.{field}: {documented:?}, {range:?}");
            checked += 1;
        }
    }
    assert!(checked > 100, "{checked}");
}

#[test]
fn every_tooltip_begins_with_plain_words_and_has_no_markup() {
    let mut docs: Vec<(String, &'static str)> = Vec::new();
    for (name, info) in all_types() {
        docs.push((name.into(), info.docs().unwrap_or_default()));
        for field in fields(info) {
            let name = format!("{name}.{}", field.name());
            docs.push((name.clone(), field.docs().unwrap_or_default()));
            if let Some(TypeInfo::Enum(info)) = field.type_info() {
                docs.extend(info.iter().filter_map(|variant| {
                    Some((format!("{name}.{}", variant.name()), variant.docs()?))
                }));
            }
        }
    }
    assert!(docs.len() > 80, "{} texts", docs.len());
    for (name, docs) in docs {
        let tooltip = tooltip(docs);
        let first = tooltip.chars().next().expect(&name);
        assert!(first.is_uppercase(), "{name} starts with {tooltip:?}");
        for start in [
            "Eq", "Fig", "Suarez", "Wang", "Range", "Default", "Source", "None",
        ] {
            assert!(
                !tooltip.starts_with(start),
                "{name} starts with {tooltip:?}"
            );
        }
        for markup in ["[", "]", "`", "\\", "**", "::", "()", "<", "http"] {
            assert!(
                !tooltip.contains(markup),
                "{name}: {markup:?} is left in {tooltip:?}"
            );
        }
        // A citation in the text is a part of its sentence; any other one is in
        // the last line.
        assert!(
            !tooltip.contains("(Suarez") && !tooltip.contains("(Wang"),
            "{tooltip:?}"
        );
        assert!(!tooltip.contains(" ."), "{tooltip:?}");
    }
}

/// The page of a style, laid out without a window.
struct Page {
    context: egui::Context,
    effects: Vec<&'static EffectType>,
    types: TypeRegistry,
    style: ComicStyle,
    stash: Stash,
    search: String,
    widgets: Widgets,
}

impl Page {
    fn of(style: ComicStyle, own: &[&'static EffectType]) -> Self {
        let mut effects = EffectRegistry::built_in().types();
        effects.extend(own);
        let context = egui::Context::default();
        // Sections open at once, so that the widgets below them do not move.
        context.all_styles_mut(|style| style.animation_time = 0.0);
        Self {
            context,
            types: types(&effects),
            effects,
            style,
            stash: Stash::default(),
            search: String::new(),
            widgets: Widgets::default(),
        }
    }

    /// Lays the page out twice, as sections take a frame to open.
    fn show(&mut self) {
        self.frame(Vec::new());
        self.frame(Vec::new());
    }

    fn frame(&mut self, events: Vec<egui::Event>) {
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(
                egui::Pos2::ZERO,
                egui::vec2(600.0, 6000.0),
            )),
            events,
            ..egui::RawInput::default()
        };
        let before = self.style.clone();
        self.widgets = Widgets::default();
        let search = Search::of(&self.search);
        let _ = self.context.clone().run_ui(input, |ui| {
            let mut editor = Editor {
                widgets: &mut self.widgets,
                stash: &self.stash,
                types: &self.types,
            };
            style(
                ui,
                &mut self.style,
                &self.effects,
                search.as_ref(),
                &mut editor,
            );
        });
        self.style = self.style.sanitized();
        self.stash.keep(&before, &self.style);
    }

    fn click(&mut self, widget: &str) {
        let [left, top, right, bottom] = *self
            .widgets
            .rects
            .get(widget)
            .unwrap_or_else(|| panic!("{widget} has no widget"));
        let pos = egui::pos2(0.5 * (left + right), 0.5 * (top + bottom));
        let button = |pressed| egui::Event::PointerButton {
            pos,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        };
        self.frame(vec![egui::Event::PointerMoved(pos)]);
        self.frame(vec![button(true)]);
        self.frame(vec![button(false)]);
        self.show();
    }

    fn has(&self, widget: &str) -> bool {
        self.widgets.rects.contains_key(widget)
    }
}

/// A style with every effect and the depth map.
fn full(effects: &[&'static EffectType]) -> ComicStyle {
    let mut full = ComicStyle {
        depth_map: Some(DepthMap {
            mapping: DepthMapping::Fixed {
                from: 1.0,
                to: 30.0,
            },
            ..DepthMap::default()
        }),
        ..ComicStyle::new()
    };
    for effect in effects {
        full.insert_any((effect.default)());
    }
    full
}

#[test]
fn showing_a_style_does_not_change_it() {
    let style = full(&EffectRegistry::built_in().types());
    let mut page = Page::of(style.clone(), &[]);
    let effects = page.effects.clone();
    let names = effects.iter().map(|effect| effect.name);
    let mut seen = std::collections::HashSet::new();
    // A search shows all settings of an effect, without those of all others.
    for name in names.chain(["depth_map"]) {
        page.search = name.into();
        page.show();
        assert_eq!(page.style, style, "{name}");
        let start = format!("{name}.");
        let is_head = |path: &str| path.ends_with(".open") || path.ends_with(".reset");
        let is_setting = |path: &str| path.starts_with(&start) && !is_head(path);
        let is_open = page.widgets.rects.keys().any(|path| is_setting(path));
        assert!(is_open, "{name} shows no settings");
        seen.extend(page.widgets.rects.keys().cloned());
    }
    for path in [
        "contours.width",
        "contours.operator",
        "colorization.color",
        "black_flats.slope.on",
        "outlines.creases.angle",
        "depth_map.mapping.to",
        "depth_map.smoothing.shrink",
        "tone_bands.levels",
        "depth_map.flip",
    ] {
        assert!(seen.contains(path), "{path} has no widget");
    }
}

#[test]
fn what_is_turned_on_again_has_its_last_settings() {
    let contours = Contours {
        width: 9.0,
        ..Contours::default()
    };
    let outlines = Outlines {
        creases: Some(Creases {
            angle: 77.0,
            ..Creases::default()
        }),
        objects: None,
        ..Outlines::default()
    };
    let flats = BlackFlats {
        slope: Some(0.5),
        value: None,
        ..BlackFlats::default()
    };
    let map = DepthMap {
        mapping: DepthMapping::Fixed { from: 2.0, to: 9.0 },
        smoothing: Some(RangeSmoothing {
            shrink: 7.0,
            ..RangeSmoothing::default()
        }),
        ..DepthMap::default()
    };
    let style = ComicStyle {
        depth_map: Some(map),
        ..ComicStyle::new()
    }
    .with(contours)
    .with(outlines)
    .with(flats);
    let mut page = Page::of(style.clone(), &[]);
    page.show();
    for section in ["contours", "outlines", "black_flats", "depth_map"] {
        page.click(&format!("{section}.open"));
    }
    for toggle in [
        "contours",
        "outlines",
        "depth_map",
        "outlines.creases.on",
        "black_flats.slope.on",
        "depth_map.smoothing.on",
    ] {
        page.click(toggle);
        assert_ne!(page.style, style, "{toggle} turns something off");
        page.click(toggle);
        assert_eq!(page.style, style, "{toggle} brings the settings back");
    }
    // Options that were never on get their documented defaults.
    page.click("outlines.objects.on");
    page.click("black_flats.value.on");
    let objects = page.style.get::<Outlines>().and_then(|o| o.objects);
    assert_eq!(objects, Some(ObjectEdges::default()));
    let value = page.style.get::<BlackFlats>().and_then(|f| f.value);
    assert_eq!(value, BlackFlats::default().value);
}

/// Widgets never see a number that is not there yet: a slider would clamp it to an end.
#[test]
fn what_was_never_on_has_its_documented_defaults() {
    let style = ComicStyle {
        depth_map: Some(DepthMap::default()),
        ..ComicStyle::new()
    };
    let mut page = Page::of(style.with(BlackFlats::default()), &[]);
    page.show();
    page.click("black_flats.open");
    page.click("depth_map.open");
    page.click("black_flats.slope.on");
    let slope = page.style.get::<BlackFlats>().and_then(|flats| flats.slope);
    assert_eq!(slope, Some(0.02));
    page.click("depth_map.mapping");
    page.click("depth_map.mapping.Fixed");
    let (near, far) = (0.1, 1000.0);
    let mapping = page.style.depth_map.map(|map| map.mapping);
    assert_eq!(
        mapping,
        Some(DepthMapping::Fixed {
            from: near,
            to: far
        })
    );
}

#[test]
fn a_search_shows_what_it_finds() {
    let mut page = Page::of(ComicStyle::new().with(Contours::default()), &[]);
    page.search = "JITTER".into();
    page.show();
    assert!(page.has("sketch"), "an effect that is off is found as well");
    assert!(page.has("sketch.jitter"), "its section is open");
    assert!(!page.has("sketch.paper") && !page.has("contours"));
    // The settings of an effect that is off are shown, but cannot be changed.
    page.click("sketch.jitter");
    assert_eq!(page.style, ComicStyle::new().with(Contours::default()));

    page.search = "contours width".into();
    page.show();
    assert!(page.has("contours.width") && !page.has("contours.color"));
    assert!(!page.has("sketch"));
    // A found effect is shown with all its settings.
    page.search = "contours".into();
    page.show();
    assert!(page.has("contours.width") && page.has("contours.color"));

    page.search = "creases angle".into();
    page.show();
    assert!(page.has("outlines.creases.angle") && !page.has("outlines.width"));

    page.search = "no such setting".into();
    page.show();
    assert!(page.widgets.rects.is_empty());
    page.search.clear();
    page.show();
    assert!(
        page.has("sketch") && !page.has("contours.width"),
        "closed again"
    );
}

#[test]
fn labels() {
    assert_eq!(label("edge_limit"), "Edge limit");
    assert_eq!(label_of_mode("MinMaxLogarithmic"), "Min max logarithmic");
}
