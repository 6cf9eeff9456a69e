//! Named styles that come with the crate, as assets and as values.
//!
//! ```no_run
//! # use bevy::prelude::*;
//! # use bevy_comics::{Comic, StyleTransition, presets};
//! # fn setup(mut commands: Commands, assets: Res<AssetServer>, camera: Single<Entity, With<Camera3d>>) {
//! commands.entity(*camera).insert(presets::NOIR.comic());
//! // By path, as a file of the game.
//! commands.entity(*camera).insert(Comic(assets.load(presets::NOIR.path())));
//! // As a value.
//! commands.entity(*camera).insert(StyleTransition::to(presets::NOIR.style(), 0.4));
//! # }
//! ```
//!
//! They are the files of `assets/styles/`, part of the binary: a game copies
//! nothing.

use std::{fmt, marker::PhantomData, path::Path};

use bevy::{
    app::App,
    asset::{Handle, io::embedded::EmbeddedAssetRegistry, uuid::Uuid},
    log::error,
};

use super::{Comic, ComicStyle};

/// A style that comes with the crate.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Preset {
    name: &'static str,
    path: &'static str,
    source: &'static str,
}

/// The scheme of the embedded assets of an app.
const SCHEME: &str = "embedded://";

impl Preset {
    /// The name in lower case with hyphens, such as `ligne-claire`.
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// The path of the asset, such as
    /// `embedded://bevy_comics/styles/ligne-claire.comic.ron`.
    pub const fn path(self) -> &'static str {
        self.path
    }

    /// The text of the style file.
    pub const fn source(self) -> &'static str {
        self.source
    }

    /// The whole style, for a camera: its effects, its settings of the camera, and, if it
    /// has one, its light on the materials of the scene.
    pub fn comic(self) -> Comic {
        Comic(self.handle())
    }

    /// The style as an asset. It is there in the frame in which a camera, a volume or a transition
    /// first has it.
    pub fn handle(self) -> Handle<ComicStyle> {
        // FNV-1a of 128 bits (Fowler, Noll and Vo 1991).
        let hash = self.path.bytes().fold(
            0x6c62_272e_07bb_0142_62b8_2175_6295_c58d,
            |hash: u128, byte| {
                (hash ^ u128::from(byte)).wrapping_mul(0x0100_0000_0000_0000_0000_013b)
            },
        );
        Handle::Uuid(Uuid::from_u128(hash), PhantomData)
    }

    /// The style as a value.
    pub fn style(self) -> ComicStyle {
        ComicStyle::from_ron(self.source).unwrap_or_else(|error| {
            // Tests read every preset.
            error!("the preset {self} is broken: {error}");
            ComicStyle::new()
        })
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl fmt::Debug for Preset {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "Preset({:?})", self.name)
    }
}

/// The preset of this name, such as `"ligne-claire"`.
pub fn find(name: &str) -> Option<Preset> {
    ALL.iter().copied().find(|preset| preset.name == name)
}

/// The preset of a [handle](Preset::handle).
pub(super) fn of(handle: &Handle<ComicStyle>) -> Option<Preset> {
    ALL.iter()
        .copied()
        .find(|preset| preset.handle() == *handle)
}

macro_rules! presets {
    ($(
        $(#[$group_docs:meta])*
        $GROUP:ident { $($(#[$docs:meta])* $CONSTANT:ident: $name:literal;)* }
    )*) => {
        $($(
            $(#[$docs])*
            pub const $CONSTANT: Preset = Preset {
                name: $name,
                path: concat!("embedded://bevy_comics/styles/", $name, ".comic.ron"),
                source: include_str!(concat!(
                    env!("CARGO_MANIFEST_DIR"), "/assets/styles/", $name, ".comic.ron"
                )),
            };
        )*)*

        $(
            $(#[$group_docs])*
            pub const $GROUP: &[Preset] = &[$($CONSTANT),*];
        )*

        /// Every preset: [`STYLES`], then [`PAPERS`].
        pub const ALL: &[Preset] = &[$($($CONSTANT,)*)*];
    };
}

presets! {
    /// The styles, in the order of the gallery: toons, books, prints, drawings, paintings, light.
    STYLES {
        /// A television toon: strong dark outlines and flat light.
        SATURDAY_MORNING: "saturday-morning";
        /// Four tones and heavy outlines under one blue-gray atmosphere.
        GRAPHIC_NOVEL: "graphic-novel";
        /// Even black lines around flat, clean colors, without ink in the shadows.
        LIGNE_CLAIRE: "ligne-claire";
        /// A vector poster: four flat tones of each color, dark blue lines around things.
        CLEAR_BANDS: "clear-bands";
        /// Pixel art: flat tones, and black pixels along edges. For a camera with
        /// [`Msaa::Off`](bevy::render::view::Msaa::Off) that draws to a small image.
        PIXEL: "pixel";
        /// A picture book in three planes: a warm foreground with heavy lines, a teal distance.
        STORYBOOK: "storybook";
        /// A naturalist's plate: dots of ink over pale washes of color, which fade with distance.
        FIELD_GUIDE: "field-guide";
        /// A church window: panes of pure color between thick leads.
        STAINED_GLASS: "stained-glass";
        /// A print of old Edo: prussian blue, persimmon and ochre under indigo lines.
        UKIYO_E: "ukiyo-e";
        /// A hiking map: contour lines of height over pale tints.
        SURVEY_MAP: "survey-map";
        /// A manga's page: black line art, shadows in a few screentones, solid blacks.
        MANGA_PAGE: "manga-page";
        /// A newspaper's comic: four inks on gray paper, out of register.
        NEWSPRINT: "newsprint";
        /// A comic book of the sixties: dots of four inks and brush lines on cheap paper.
        SILVER_AGE: "silver-age";
        /// Two spot inks in fine dots on warm paper.
        RISOGRAPH: "risograph";
        /// Pop art: large dots of bright ink, thick black lines.
        POP_POSTER: "pop-poster";
        /// A poster of the twenties in red, cream and black.
        RED_POSTER: "red-poster";
        /// A print of two blocks: solid blacks and few broad cuts over a tone of ochre.
        WOODCUT: "woodcut";
        /// A steel engraving: fine lines that follow the form, crossed in the shadows.
        ENGRAVING: "engraving";
        /// A crime comic: solid shadows that break up into strokes towards the light.
        HARD_BOILED: "hard-boiled";
        /// Graphite strokes on paper, drawn anew eight times a second.
        PENCIL_SKETCH: "pencil-sketch";
        /// A study in graphite: soft strokes in two directions on grained paper.
        PENCIL_STUDY: "pencil-study";
        /// A doodle in blue ballpoint, crossed again and again.
        BALLPOINT: "ballpoint";
        /// Charcoal: dark strokes over rubbed grays on rough paper.
        CHARCOAL: "charcoal";
        /// A study in red chalk on toned paper.
        RED_CHALK: "red-chalk";
        /// White lines on cyanotype blue.
        BLUEPRINT: "blueprint";
        /// Ink wash on rice paper, with brush lines that run dry.
        SUMI_E: "sumi-e";
        /// Washes of the scene's own colors on rough paper, under loose ink.
        WATERCOLOR: "watercolor";
        /// Flat patches of opaque color on rough paper, soft lines in the colors that they
        /// surround.
        GOUACHE: "gouache";
        /// Dabs of thick paint along the forms, golden lights and violet shadows, no lines.
        OIL_SKETCH: "oil-sketch";
        /// Two hues in five tones: copper in front of a teal distance.
        COPPER_AND_TEAL: "copper-and-teal";
        /// The last hour of light: amber lights, plum shadows, brown lines.
        GOLDEN_HOUR: "golden-hour";
        /// Evening: violet distance, warm lines that thin out with it.
        TWILIGHT_TOON: "twilight-toon";
        /// Dark and clear nearby, almost white in the distance.
        MISTY_MORNING: "misty-morning";
        /// Day for night: deep blues, moonlit edges, black shadows.
        COBALT_NIGHT: "cobalt-night";
        /// Violet and magenta tones, glowing cyan lines.
        NEON_NIGHT: "neon-night";
        /// A film noir: solid shadows and one gray on cold white.
        NOIR: "noir";
        /// Brown-gray bands, outlines and dark corners.
        SILENT_FILM: "silent-film";
    }

    /// Pictures of the two papers, for those who compare: \[CS\] first, then \[CL\].
    PAPERS {
        /// A brown old photograph. \[CS\] Figure 3.
        SEPIA: "sepia";
        /// A red atmosphere that grows with distance. \[CS\] Figure 4, row 1.
        CRIMSON_DUSK: "crimson-dusk";
        /// One blue atmosphere for the whole picture, and colors that fade with
        /// distance. \[CS\] Figure 4, row 2.
        MUSEUM_PRINT: "museum-print";
        /// A green atmosphere with solid ink on steep and dark areas. \[CS\] Figure 4,
        /// row 3.
        EMERALD_INK: "emerald-ink";
        /// Figure 7 (a) of \[CL\].
        FIGURE_7A: "figure-7a";
        /// Figure 7 (b) of \[CL\].
        FIGURE_7B: "figure-7b";
        /// Figure 8 (a) of \[CL\].
        FIGURE_8A: "figure-8a";
        /// Figure 8 (b) of \[CL\].
        FIGURE_8B: "figure-8b";
        /// Figure 8 (c) of \[CL\].
        FIGURE_8C: "figure-8c";
    }
}

/// Makes the presets loadable.
pub(super) fn embed(app: &mut App) {
    let embedded = app
        .world_mut()
        .get_resource_or_init::<EmbeddedAssetRegistry>();
    for preset in ALL {
        let path = preset.path.strip_prefix(SCHEME).unwrap_or(preset.path);
        let file = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("assets/styles")
            .join(format!("{preset}.comic.ron"));
        embedded.insert_asset(file, Path::new(path), preset.source.as_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of styles are those of the second paper or of later effects.
    #[test]
    fn styles_do_not_lean_on_contours() {
        for preset in STYLES {
            let contours = preset.style().get::<crate::Contours>().copied();
            assert_eq!(contours, None, "{preset}");
        }
    }

    #[test]
    fn every_preset_reads_and_is_within_its_ranges() {
        for preset in ALL {
            let style = ComicStyle::from_ron(preset.source)
                .unwrap_or_else(|error| panic!("{preset}: {error}"));
            assert_eq!(
                style,
                style.sanitized(),
                "{preset} is changed by its own clamps"
            );
            assert_eq!(style, preset.style());
            assert!(!style.name.is_empty(), "{preset} has no title");
            assert!(!style.partial, "{preset} is a complete style");
        }
    }

    #[test]
    fn every_style_file_is_a_preset() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/styles");
        for entry in std::fs::read_dir(folder).expect("the folder of styles") {
            let file = entry.expect("entry").file_name();
            let file = file.to_string_lossy();
            let name = file.strip_suffix(".comic.ron").expect("only styles");
            assert!(find(name).is_some(), "{file} is not in the list");
        }
    }

    #[test]
    fn names_are_found_and_unique() {
        for preset in ALL {
            assert_eq!(find(preset.name()), Some(*preset));
            assert_eq!(of(&preset.handle()), Some(*preset));
        }
        assert_eq!(find("no-such-preset"), None);
    }
}
