//! What a style sets on a camera besides effects, and what it does to the scene.

use bevy::{
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    prelude::*,
    render::view::Msaa,
};
use serde::{Deserialize, Serialize};

use super::ComicStyle;
#[cfg(feature = "toon")]
use crate::toon::{CameraScene, StyleScene};

/// What a [`ComicStyle`] sets on a camera with a [`Comic`](crate::Comic), besides effects.
///
/// Without the style, the camera has its own settings again.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StyleCamera {
    /// The engine's dither. Default: [`StyleDither::Auto`].
    pub dither: StyleDither,
    /// Samples per pixel: `Off`, `Sample2`, `Sample4` or `Sample8` in files. `None` keeps the
    /// camera's. Default: `None`.
    #[serde(with = "msaa")]
    pub msaa: Option<Msaa>,
    /// Tonemapping, by the names of Bevy's [`Tonemapping`], but `Off` for [`Tonemapping::None`] in
    /// files. `None` keeps the camera's. Default: `None`.
    #[serde(with = "tonemapping")]
    pub tonemapping: Option<Tonemapping>,
}

/// Whether a style switches the engine's dither ([`DebandDither`]) on or off.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum StyleDither {
    /// Off while the style has an effect that divides tones (`Effect::DIVIDES_TONES`), which would
    /// show dither as dots; otherwise as the camera has it.
    #[default]
    Auto,
    /// On.
    On,
    /// Off.
    Off,
}

impl StyleCamera {
    /// These settings over others: what they leave open is that of the others.
    pub(super) fn over(self, base: Self) -> Self {
        Self {
            dither: match self.dither {
                StyleDither::Auto => base.dither,
                dither => dither,
            },
            msaa: self.msaa.or(base.msaa),
            tonemapping: self.tonemapping.or(base.tonemapping),
        }
    }

    fn deband_dither(self, style: &ComicStyle) -> Option<DebandDither> {
        match self.dither {
            StyleDither::On => Some(DebandDither::Enabled),
            StyleDither::Off => Some(DebandDither::Disabled),
            StyleDither::Auto => style
                .effects()
                .any(|effect| effect.effect_type().divides_tones && effect.any_strength() > 0.0)
                .then_some(DebandDither::Disabled),
        }
    }
}

/// On a camera: the settings that a style has replaced.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
struct Replaced {
    dither: Option<Setting<DebandDither>>,
    msaa: Option<Setting<Msaa>>,
    tonemapping: Option<Setting<Tonemapping>>,
}

/// A component that a style has set.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Setting<T> {
    /// That of the camera.
    own: Option<T>,
    set: T,
}

/// Gives a camera what a style has besides effects, in place of what the last style set. With an
/// empty style, the camera has its own settings again, and its scene too.
pub(super) fn set_camera(camera: &mut EntityWorldMut, style: &ComicStyle) {
    let wanted = style.camera;
    let before = camera.get::<Replaced>().copied().unwrap_or_default();
    let mut now = before;
    replace(camera, &mut now.dither, wanted.deband_dither(style));
    replace(camera, &mut now.msaa, wanted.msaa);
    replace(camera, &mut now.tonemapping, wanted.tonemapping);
    if now != before {
        camera.insert(now);
    }
    #[cfg(feature = "toon")]
    set_scene(camera, style.scene.as_ref());
}

/// Whether a style has replaced settings of a camera.
pub(super) fn has_set_camera(camera: &EntityWorldMut) -> bool {
    camera
        .get::<Replaced>()
        .is_some_and(|replaced| *replaced != Replaced::default())
}

#[cfg(feature = "toon")]
fn set_scene(camera: &mut EntityWorldMut, scene: Option<&StyleScene>) {
    match scene {
        Some(scene) => {
            let known = camera.get::<CameraScene>();
            if known.is_none_or(|known| known.0 != *scene) {
                camera.insert(CameraScene(scene.clone()));
            }
        }
        None => {
            camera.remove::<CameraScene>();
        }
    }
}

/// Sets a component, or puts back the camera's own. What the game has changed since a style set it
/// is the camera's own.
fn replace<T: Component + Copy + PartialEq>(
    camera: &mut EntityWorldMut,
    setting: &mut Option<Setting<T>>,
    wanted: Option<T>,
) {
    let current = camera.get::<T>().copied();
    let own = match *setting {
        Some(setting) if current == Some(setting.set) => setting.own,
        _ => current,
    };
    let shown = wanted.or(own);
    if shown != current {
        match shown {
            Some(shown) => camera.insert(shown),
            None => camera.remove::<T>(),
        };
    }
    *setting = wanted.map(|set| Setting { own, set });
}

/// How an option of an enum of the engine is written in files.
macro_rules! option_by_name {
    ($module:ident, $Type:ident = $path:literal, $($(#[$attribute:meta])* $Variant:ident),+) => {
        mod $module {
            use serde::{Deserialize, Deserializer, Serialize, Serializer};

            use super::$Type;

            #[derive(Serialize, Deserialize)]
            #[serde(remote = $path)]
            enum Name {
                $($(#[$attribute])* $Variant,)+
            }

            #[derive(Serialize, Deserialize)]
            #[serde(transparent)]
            struct Named(#[serde(with = "Name")] $Type);

            pub fn serialize<S: Serializer>(
                value: &Option<$Type>,
                serializer: S,
            ) -> Result<S::Ok, S::Error> {
                value.map(Named).serialize(serializer)
            }

            pub fn deserialize<'de, D: Deserializer<'de>>(
                deserializer: D,
            ) -> Result<Option<$Type>, D::Error> {
                let named = Option::<Named>::deserialize(deserializer)?;
                Ok(named.map(|Named(value)| value))
            }
        }
    };
}

option_by_name!(msaa, Msaa = "Msaa", Off, Sample2, Sample4, Sample8);
option_by_name!(
    tonemapping,
    Tonemapping = "Tonemapping",
    // `None` is that of the option.
    #[serde(rename = "Off")]
    None,
    Reinhard,
    ReinhardLuminance,
    AcesFitted,
    AgX,
    SomewhatBoringDisplayTransform,
    TonyMcMapface,
    BlenderFilmic,
    KhronosPbrNeutral
);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Comic, ComicsPlugin, Outlines, ToneBands, Vignette, presets, style::ComicGrade};
    #[cfg(feature = "toon")]
    use crate::{StyleTransition, ToonLight, style::TransitionEasing};

    /// A camera with settings of its own and a style, in an app without a renderer.
    fn styled(style: ComicStyle) -> (App, Entity, Handle<ComicStyle>) {
        let mut app = App::new();
        app.add_plugins((
            TaskPoolPlugin::default(),
            AssetPlugin::default(),
            ComicsPlugin,
        ));
        let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
        let handle = styles.add(style);
        let own = (
            DebandDither::Enabled,
            Msaa::Sample4,
            Tonemapping::Reinhard,
            Comic(handle.clone()),
        );
        let camera = app.world_mut().spawn((Camera3d::default(), own)).id();
        app.update();
        (app, camera, handle)
    }

    fn settings(app: &App, camera: Entity) -> (DebandDither, Msaa, Tonemapping) {
        let world = app.world();
        (
            *world.get(camera).expect("dither"),
            *world.get(camera).expect("samples"),
            *world.get(camera).expect("tonemapping"),
        )
    }

    #[test]
    fn a_comic_sets_a_camera_and_gives_its_own_settings_back() {
        let camera = StyleCamera {
            msaa: Some(Msaa::Off),
            tonemapping: Some(Tonemapping::AcesFitted),
            ..StyleCamera::default()
        };
        let style = ComicStyle {
            camera,
            ..ComicStyle::new().with(ToneBands::default())
        };
        let (mut app, camera, handle) = styled(style);
        let set = (DebandDither::Disabled, Msaa::Off, Tonemapping::AcesFitted);
        assert_eq!(settings(&app, camera), set);

        // Its file changes. The game sets a component itself.
        let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
        let mut style = styles.get_mut(&handle).expect("a style");
        style.remove::<ToneBands>();
        style.camera.msaa = None;
        drop(style);
        for _ in 0..2 {
            app.update();
        }
        let set = (
            DebandDither::Enabled,
            Msaa::Sample4,
            Tonemapping::AcesFitted,
        );
        assert_eq!(settings(&app, camera), set);
        app.world_mut().entity_mut(camera).insert(Msaa::Sample2);
        app.world_mut().entity_mut(camera).remove::<Comic>();
        app.update();
        let own = (DebandDither::Enabled, Msaa::Sample2, Tonemapping::Reinhard);
        assert_eq!(settings(&app, camera), own);
    }

    #[test]
    fn a_clone_of_a_camera_gives_back_the_settings_of_the_camera() {
        let (mut app, camera, _) = styled(ComicStyle::new().with(ToneBands::default()));
        assert_eq!(settings(&app, camera).0, DebandDither::Disabled);
        let clone = app.world_mut().entity_mut(camera).clone_and_spawn();
        app.update();
        app.world_mut().entity_mut(clone).remove::<Comic>();
        app.update();
        let own = (DebandDither::Enabled, Msaa::Sample4, Tonemapping::Reinhard);
        assert_eq!(settings(&app, clone), own);
    }

    #[test]
    fn an_empty_comic_comes_before_or_after_the_style() {
        let settings = StyleCamera {
            msaa: Some(Msaa::Off),
            ..StyleCamera::default()
        };
        let style = ComicStyle {
            camera: settings,
            ..ComicStyle::new()
        };
        let (mut app, camera, _) = styled(ComicStyle::new());
        for is_before in [true, false] {
            app.world_mut().entity_mut(camera).remove::<Comic>();
            app.update();
            assert_eq!(app.world().get(camera), Some(&Msaa::Sample4));
            for is_comic in [is_before, !is_before] {
                if is_comic {
                    let mut camera = app.world_mut().entity_mut(camera);
                    camera.insert(Comic::default());
                } else {
                    style.apply(&mut app.world_mut().commands().entity(camera));
                    app.world_mut().flush();
                }
                app.update();
            }
            assert_eq!(app.world().get(camera), Some(&Msaa::Off), "{is_before}");
        }
    }

    #[test]
    fn a_grade_lies_over_whatever_style_a_camera_has() {
        let (mut app, camera, _) = styled(ComicStyle::new().with(Outlines::default()));
        let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
        let dark = styles.add(ComicStyle::new().with(Vignette::default()));
        let bands = styles.add(ComicStyle::new().with(ToneBands::default()));
        let set = |app: &mut App, change: &dyn Fn(&mut EntityWorldMut)| {
            change(&mut app.world_mut().entity_mut(camera));
            app.update();
            let camera = app.world().entity(camera);
            [
                camera.contains::<Outlines>(),
                camera.contains::<ToneBands>(),
                camera.contains::<Vignette>(),
            ]
        };
        let grade = |camera: &mut EntityWorldMut| {
            camera.insert(ComicGrade(dark.clone()));
        };
        assert_eq!(set(&mut app, &grade), [true, false, true]);
        let other = |camera: &mut EntityWorldMut| {
            camera.insert(Comic(bands.clone()));
        };
        assert_eq!(set(&mut app, &other), [false, true, true]);
        let ungrade = |camera: &mut EntityWorldMut| {
            camera.remove::<ComicGrade>();
        };
        assert_eq!(set(&mut app, &ungrade), [false, true, false]);
        set(&mut app, &grade);
        let unstyle = |camera: &mut EntityWorldMut| {
            camera.remove::<Comic>();
        };
        assert_eq!(set(&mut app, &unstyle), [false, false, true]);
        assert_eq!(set(&mut app, &ungrade), [false, false, false]);
    }

    #[cfg(feature = "toon")]
    #[test]
    fn a_scene_follows_its_file_and_blends() {
        let lit = |highlight, sections| StyleScene {
            light: ToonLight {
                highlight,
                ..ToonLight::default()
            },
            sections,
            ..StyleScene::default()
        };
        let (mut app, camera, handle) = styled(ComicStyle::new().with_scene(lit(1.0, None)));
        let scene = |app: &App| {
            let scene = app.world().get::<CameraScene>(camera);
            scene.map(|scene| scene.0.clone())
        };
        assert_eq!(scene(&app), Some(lit(1.0, None)));
        let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
        styles.get_mut(&handle).expect("a style").scene = Some(lit(2.0, None));
        for _ in 0..2 {
            app.update();
        }
        assert_eq!(scene(&app), Some(lit(2.0, None)));

        // Lights blend, the rest changes at the end.
        let target = ComicStyle::new().with_scene(lit(3.0, Some(45.0)));
        let transition = StyleTransition::to(target, 1.0).with_easing(TransitionEasing::Linear);
        app.world_mut().entity_mut(camera).insert(transition);
        app.insert_resource(Time::<()>::default());
        app.update();
        let mut clock = app.world_mut().resource_mut::<Time>();
        clock.advance_by(std::time::Duration::from_millis(500));
        app.update();
        assert_eq!(scene(&app), Some(lit(2.5, None)));
        app.update();
        assert_eq!(scene(&app), Some(lit(3.0, Some(45.0))));
        app.world_mut().entity_mut(camera).remove::<Comic>();
        app.update();
        assert_eq!(scene(&app), None);
    }

    #[test]
    fn a_preset_is_there_in_its_first_frame() {
        let (mut app, camera, _) = styled(ComicStyle::new());
        let mut entity = app.world_mut().entity_mut(camera);
        entity.insert(presets::LIGNE_CLAIRE.comic());
        app.update();
        let lines = app.world().get::<Outlines>(camera);
        assert!(lines.is_some(), "in the frame in which a camera has it");
        assert_eq!(lines, presets::LIGNE_CLAIRE.style().get::<Outlines>());
    }

    #[test]
    fn settings_of_a_camera_are_part_of_files() {
        let text = "(version: 3, camera: (dither: Off, msaa: Sample2, tonemapping: Off))";
        let style = ComicStyle::from_ron(text).expect("readable");
        let camera = StyleCamera {
            dither: StyleDither::Off,
            msaa: Some(Msaa::Sample2),
            tonemapping: Some(Tonemapping::None),
        };
        assert_eq!(style.camera, camera);
        let again = ComicStyle::from_ron(&style.to_ron().expect("text")).expect("readable");
        assert_eq!(again, style);
        let kept = ComicStyle::from_ron("(version: 3, camera: (tonemapping: None))");
        assert_eq!(kept.expect("readable"), ComicStyle::new());
        // A partial style keeps what it leaves open.
        let partial = "(version: 3, partial: true, camera: (msaa: Off))";
        let over = ComicStyle::from_ron(partial)
            .expect("readable")
            .over(&style);
        let msaa = Some(Msaa::Off);
        assert_eq!(over.camera, StyleCamera { msaa, ..camera });
    }
}
