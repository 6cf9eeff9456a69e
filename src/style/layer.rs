//! Styles over a camera's own style.

use bevy::prelude::*;

use super::{
    Comic, ComicStyle,
    camera::{has_set_camera, set_camera},
};
use crate::{
    depth::DepthMap,
    effect::{EffectRegistry, EffectType},
    page::PageHeight,
};

/// On a camera that a style was applied to: what it looks like without.
#[derive(Component, Clone, Debug)]
pub(super) struct StyleLayer {
    /// The camera's own style.
    own: ComicStyle,
    /// The style that was applied.
    base: ComicStyle,
    /// The style that lies over the camera's own: `base`, and the [`Grade`] over it.
    style: ComicStyle,
    /// The result, as it was written to the camera's components.
    written: ComicStyle,
}

/// On a camera with a [`ComicGrade`](super::ComicGrade) that has loaded: its style, as a partial
/// one.
#[derive(Component, Clone, Debug)]
#[component(clone_behavior = Ignore)]
struct Grade(ComicStyle);

/// A style with the camera's grade over it.
pub(super) fn graded(camera: &EntityWorldMut, style: &ComicStyle) -> ComicStyle {
    match camera.get::<Grade>() {
        Some(grade) => grade.0.over(style),
        None => style.clone(),
    }
}

/// Gives a camera another grade, or takes it away.
pub(super) fn set_grade(camera: &mut EntityWorldMut, grade: Option<ComicStyle>) {
    let nothing = ComicStyle::new().partial();
    let base = camera.get::<StyleLayer>().map(|layer| layer.base.clone());
    let has_grade = grade.is_some();
    match grade {
        Some(grade) => camera.insert(Grade(grade.partial())),
        None => camera.remove::<Grade>(),
    };
    match base {
        Some(base) if has_grade || base != nothing => base.lay_over(camera),
        Some(_) => ComicStyle::take_off(camera),
        None if has_grade => nothing.lay_over(camera),
        None => {}
    }
}

/// On a camera in volumes.
#[derive(Component, Clone, Debug, PartialEq)]
pub(super) struct PlaceStyle {
    /// The volumes from below, and how much of each is seen.
    pub volumes: Vec<SeenVolume>,
    /// The style that was applied to the camera before.
    pub below: Option<ComicStyle>,
}

/// A volume, its style, and how much of it is seen.
pub(super) type SeenVolume = (Entity, AssetId<ComicStyle>, f32);

impl StyleLayer {
    /// The camera's own style, with what the game has changed since the style was
    /// applied: components that the style says nothing about, and effects that
    /// were added. Edits of what the style has set are gone with the style.
    fn own_now(mut self, current: &ComicStyle, types: &[&'static EffectType]) -> ComicStyle {
        for effect in types {
            let name = effect.name;
            let here = current.by_name(name);
            let added = self.written.by_name(name).is_none() && here.is_some();
            if added || !self.style.decides(name) {
                self.own.remove_by_name(name);
                if let Some(effect) = here {
                    self.own.insert_any(effect.boxed());
                }
            }
        }
        if self.style.depth_map.is_none() {
            self.own.depth_map = current.depth_map;
        }
        let added_page = self.written.page.is_none() && current.page.is_some();
        if added_page || (self.style.partial && self.style.page.is_none()) {
            self.own.page = current.page;
        }
        self.own
    }

    /// `base`, with what differs between what was written and `look`.
    fn edited_base(&self, look: &ComicStyle) -> ComicStyle {
        let mut base = self.base.clone();
        base.take_edits(&self.written, look);
        base
    }
}

impl ComicStyle {
    /// Whether the effect of this name is on or off by this style.
    fn decides(&self, name: &str) -> bool {
        !self.partial || self.by_name(name).is_some() || self.off.contains(name)
    }

    /// The style of a camera whose own style is `base` when this one lies over
    /// it. The result is partial only if both are.
    #[must_use]
    pub fn over(&self, base: &Self) -> Self {
        let mut look = if self.partial {
            base.clone()
        } else {
            Self::new()
        };
        look.name.clone_from(&self.name);
        look.depth_map = self.depth_map.or(base.depth_map);
        look.camera = self.camera.over(look.camera);
        #[cfg(feature = "toon")]
        if self.scene.is_some() {
            look.scene.clone_from(&self.scene);
        }
        look.page = self.page.or(look.page);
        for effect in self.effects.iter() {
            look.insert_any(effect.boxed());
        }
        for name in &self.off {
            look.remove_by_name(name);
            if look.partial {
                look.off.insert(name);
            }
        }
        look
    }

    /// The components of a camera, as a complete style without a name: its depth
    /// map, its page, and those of its effects that `registry` knows. `camera` and `scene` are those
    /// of the style that was applied to it.
    pub fn of(camera: EntityRef, registry: &EffectRegistry) -> Self {
        let mut style = Self {
            depth_map: camera.get().copied(),
            page: camera.get::<PageHeight>().map(|page| page.0),
            ..Self::new()
        };
        for effect in registry.types() {
            if let Some(effect) = (effect.get)(camera) {
                style.insert_any(effect.boxed());
            }
        }
        if let Some(layer) = camera.get::<StyleLayer>() {
            style.take_surroundings(&layer.written);
        }
        style
    }

    /// Takes what another style has besides effects and a depth map.
    fn take_surroundings(&mut self, other: &Self) {
        self.camera = other.camera;
        #[cfg(feature = "toon")]
        self.scene.clone_from(&other.scene);
    }

    fn has_same_surroundings(&self, other: &Self) -> bool {
        #[cfg(feature = "toon")]
        let is_same_scene = self.scene == other.scene;
        #[cfg(not(feature = "toon"))]
        let is_same_scene = true;
        self.camera == other.camera && is_same_scene
    }

    /// Applies the style to a camera, over the camera's own style and in place
    /// of the style that was applied before: inserts and removes the components
    /// of the effects that the app knows. Between calls the components belong to
    /// the game and may be edited.
    ///
    /// [`camera`](Self::camera) and [`scene`](Self::scene) apply to cameras that have a [`Comic`],
    /// which may be empty.
    pub fn apply(&self, camera: &mut EntityCommands) {
        let style = self.clone();
        camera.queue(move |mut camera: EntityWorldMut| style.lay_over(&mut camera));
    }

    /// Takes the applied style off a camera, which then has its own style again.
    /// A camera without a style does not change.
    pub fn remove_from(camera: &mut EntityCommands) {
        camera.queue(|mut camera: EntityWorldMut| Self::take_off(&mut camera));
    }

    pub(super) fn take_off(camera: &mut EntityWorldMut) {
        let own = own_style(camera);
        if camera.contains::<StyleLayer>() {
            own.replace_all(camera);
        }
    }

    /// Makes this style the camera's own, as a complete one, with no style over it except that of
    /// its [`ComicGrade`](super::ComicGrade).
    pub fn set_as_own(&self, camera: &mut EntityCommands) {
        let style = self.clone();
        camera.queue(move |mut camera: EntityWorldMut| style.replace_all(&mut camera));
    }

    /// Makes this style the camera's own, in place of the applied one, with the grade over it.
    fn replace_all(&self, camera: &mut EntityWorldMut) {
        camera.remove::<StyleLayer>();
        self.write(camera);
        set_camera(camera, &Self::new());
        if camera.contains::<Grade>() {
            Self::new().partial().lay_over(camera);
        }
    }

    /// Makes a camera look like this complete style, which was made by editing
    /// what it looked like before. Over a camera's own style it takes the place of
    /// the applied style, so that the camera has its own style again when that is
    /// removed.
    pub fn edit(&self, camera: &mut EntityCommands) {
        let style = self.clone();
        camera.queue(move |mut camera: EntityWorldMut| {
            let mut own = own_style(&camera);
            let layer = camera.get::<StyleLayer>().cloned();
            match (layer, camera.take::<PlaceStyle>()) {
                (Some(layer), Some(mut place)) => {
                    let edited = place.below.as_mut().unwrap_or(&mut own);
                    edited.take_edits(&layer.written, &style);
                    let base = place.below.clone().unwrap_or(layer.base);
                    lay_over(&mut camera, own, [base, layer.style], style);
                    camera.insert(place);
                }
                (Some(layer), None) => {
                    let base = layer.edited_base(&style);
                    lay_over(&mut camera, own, [base, style.clone()], style);
                }
                (None, _) => style.write(&mut camera),
            }
        });
    }

    pub(super) fn lay_over(self, camera: &mut EntityWorldMut) {
        let own = own_style(camera);
        let style = graded(camera, &self);
        let written = style.over(&own);
        lay_over(camera, own, [self, style], written);
    }

    /// Changes what differs between two complete styles.
    fn take_edits(&mut self, before: &Self, after: &Self) {
        for effect in after.effects.iter() {
            let before = before.by_name(effect.name());
            if before.is_none_or(|before| *before != *effect) {
                self.insert_any(effect.boxed());
            }
        }
        for effect in before.effects.iter() {
            let name = effect.name();
            if after.by_name(name).is_none() {
                self.remove_by_name(name);
                if self.partial {
                    self.off.insert(name);
                }
            }
        }
        if before.depth_map != after.depth_map {
            self.depth_map = after.depth_map;
        }
        if before.page != after.page {
            self.page = after.page;
        }
        if !before.has_same_surroundings(after) {
            self.take_surroundings(after);
        }
    }

    /// Makes the camera's components those of this style, as a complete one.
    fn write(&self, camera: &mut EntityWorldMut) {
        match self.depth_map {
            Some(map) => camera.insert(map),
            None => camera.remove::<DepthMap>(),
        };
        match self.page {
            Some(height) => camera.insert(PageHeight(height)),
            None => camera.remove::<PageHeight>(),
        };
        for effect in known_types(camera) {
            if self.by_name(effect.name).is_none() {
                (effect.remove)(camera);
            }
        }
        for effect in self.effects.iter() {
            effect.insert_into(camera);
        }
    }
}

/// Writes `written`, a complete style, to the camera, as the result of `style` over its `own` style.
/// `base`: the style without the camera's grade.
pub(super) fn lay_over(
    camera: &mut EntityWorldMut,
    own: ComicStyle,
    [base, style]: [ComicStyle; 2],
    written: ComicStyle,
) {
    written.write(camera);
    if camera.contains::<Comic>() {
        set_camera(camera, &written);
    }
    camera.insert(StyleLayer {
        own,
        base,
        style,
        written,
    });
}

/// Gives a camera with a new [`Comic`] what the style that was applied before has besides effects.
/// If that was applied with it, what the game has set since stays.
pub(super) fn set_surroundings(camera: &mut EntityWorldMut) {
    if let Some(layer) = camera.get::<StyleLayer>()
        && !has_set_camera(camera)
    {
        let written = layer.written.clone();
        set_camera(camera, &written);
    }
}

/// The camera's style without the style that was applied to it.
pub(super) fn own_style(camera: &EntityWorldMut) -> ComicStyle {
    let Some(registry) = camera.world().get_resource::<EffectRegistry>() else {
        return ComicStyle::new();
    };
    let current = ComicStyle::of(EntityRef::from(camera), registry);
    match camera.get::<StyleLayer>() {
        Some(layer) => layer.clone().own_now(&current, &registry.types()),
        None => current,
    }
}

fn known_types(camera: &EntityWorldMut) -> Vec<&'static EffectType> {
    camera
        .world()
        .get_resource::<EffectRegistry>()
        .map(EffectRegistry::types)
        .unwrap_or_default()
}

/// The style that was applied to the camera, without the camera's grade, but with what the game has
/// edited since.
pub(super) fn applied_style(camera: &EntityWorldMut) -> Option<ComicStyle> {
    let layer = camera.get::<StyleLayer>()?;
    let registry = camera.world().get_resource::<EffectRegistry>()?;
    let current = ComicStyle::of(EntityRef::from(camera), registry);
    let is_edited = current.effects != layer.written.effects;
    Some(if is_edited {
        layer.edited_base(&current)
    } else {
        layer.base.clone()
    })
}
