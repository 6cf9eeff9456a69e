//! The last settings of the parts of a style that were turned off.

use bevy::{
    platform::collections::HashMap,
    reflect::{PartialReflect, ReflectRef, enums::Enum, structs::Struct},
};

use bevy_comics::{ComicStyle, DepthMap, effect::AnyEffect};

/// What the effects, options and modes of one camera were set to when they were
/// last turned off, so that turning them on again brings the settings back.
#[derive(Default)]
pub struct Stash {
    depth_map: Option<DepthMap>,
    /// By name.
    effects: HashMap<&'static str, Box<dyn AnyEffect>>,
    /// Enum values with fields, an `Option` among them, by [`key`].
    variants: HashMap<String, Box<dyn PartialReflect>>,
}

/// The key of a variant: the path of its field in the style and its name.
fn key(path: &str, variant: &str) -> String {
    format!("{path}.{variant}")
}

impl Stash {
    /// Keeps what a change of the style turns off.
    pub fn keep(&mut self, before: &ComicStyle, after: &ComicStyle) {
        match (&before.depth_map, &after.depth_map) {
            (Some(before), Some(after)) => self.keep_fields("depth_map", before, after),
            (Some(before), None) => self.depth_map = Some(*before),
            (None, _) => {}
        }
        for effect in before.effects() {
            let name = effect.effect_type().name;
            match after.by_name(name) {
                Some(after) => self.keep_fields(name, effect.as_struct(), after.as_struct()),
                None => {
                    self.effects.insert(name, effect.boxed());
                }
            }
        }
    }

    /// The last depth map, if it was turned off.
    pub fn depth_map(&self) -> Option<DepthMap> {
        self.depth_map
    }

    /// The last settings of an effect, if it was turned off.
    pub fn effect(&self, name: &str) -> Option<Box<dyn AnyEffect>> {
        self.effects.get(name).map(|effect| effect.boxed())
    }

    /// The last value of an enum field with this variant, if it had another one
    /// since.
    pub fn variant(&self, path: &str, variant: &str) -> Option<&dyn PartialReflect> {
        self.variants.get(&key(path, variant)).map(AsRef::as_ref)
    }

    /// Keeps what a change of a struct at a path turns off.
    pub fn keep_fields(&mut self, path: &str, before: &dyn Struct, after: &dyn Struct) {
        for (name, before) in before.iter_fields() {
            if let Some(after) = after.field(name) {
                self.keep_field(&format!("{path}.{name}"), before, after);
            }
        }
    }

    fn keep_field(&mut self, path: &str, before: &dyn PartialReflect, after: &dyn PartialReflect) {
        match (before.reflect_ref(), after.reflect_ref()) {
            (ReflectRef::Struct(before), ReflectRef::Struct(after)) => {
                self.keep_fields(path, before, after);
            }
            (ReflectRef::Enum(before), ReflectRef::Enum(after)) => {
                self.keep_variant(path, before, after);
            }
            _ => {}
        }
    }

    fn keep_variant(&mut self, path: &str, before: &dyn Enum, after: &dyn Enum) {
        if before.variant_name() != after.variant_name() {
            if before.field_len() > 0 {
                let key = key(path, before.variant_name());
                self.variants.insert(key, before.to_dynamic());
            }
            return;
        }
        for (i, field) in before.iter_fields().enumerate() {
            let Some(after) = after.field_at(i) else {
                continue;
            };
            match field.name() {
                Some(name) => self.keep_field(&format!("{path}.{name}"), field.value(), after),
                // The value of an option has the path of the option.
                None => self.keep_field(path, field.value(), after),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_comics::{
        BlackFlats, Contours, DepthMapping, Outlines, depth::RangeSmoothing, lines::Creases,
    };

    fn kept(before: &ComicStyle, after: &ComicStyle) -> Stash {
        let mut stash = Stash::default();
        stash.keep(before, after);
        stash
    }

    #[test]
    fn an_effect_that_is_turned_off_is_kept() {
        let wide = ComicStyle::new().with(Contours {
            width: 9.0,
            ..Contours::default()
        });
        let stash = kept(&wide, &ComicStyle::new());
        let effect = stash.effect("contours").expect("kept");
        let contours = effect.as_any().downcast_ref::<Contours>();
        assert_eq!(contours, wide.get::<Contours>());
        assert!(kept(&ComicStyle::new(), &wide).effect("contours").is_none());
        assert!(kept(&wide, &wide).effect("contours").is_none());
    }

    #[test]
    fn options_inside_an_effect_are_kept() {
        let creases = Creases {
            angle: 77.0,
            ..Creases::default()
        };
        let style = ComicStyle::new()
            .with(Outlines {
                creases: Some(creases),
                ..Outlines::default()
            })
            .with(BlackFlats {
                slope: Some(0.5),
                ..BlackFlats::default()
            });
        let off = style
            .clone()
            .with(Outlines {
                creases: None,
                ..Outlines::default()
            })
            .with(BlackFlats::default());
        let stash = kept(&style, &off);
        let mut outlines = Outlines::default();
        let stored = stash.variant("outlines.creases", "Some").expect("kept");
        outlines.creases.apply(stored);
        assert_eq!(outlines.creases, Some(creases));
        assert!(stash.variant("black_flats.slope", "Some").is_some());
        assert!(stash.variant("black_flats.value", "Some").is_none());
    }

    #[test]
    fn parts_of_the_depth_map_are_kept() {
        let smoothing = RangeSmoothing {
            shrink: 7.0,
            ..RangeSmoothing::default()
        };
        let map = DepthMap {
            mapping: DepthMapping::Fixed { from: 2.0, to: 9.0 },
            smoothing: Some(smoothing),
            ..DepthMap::default()
        };
        let with = |depth_map| ComicStyle {
            depth_map,
            ..ComicStyle::new()
        };
        let other = DepthMap {
            mapping: DepthMapping::MinMax,
            smoothing: None,
            ..map
        };
        let stash = kept(&with(Some(map)), &with(Some(other)));
        let mut restored = other;
        let stored = stash.variant("depth_map.mapping", "Fixed").expect("kept");
        restored.mapping.apply(stored);
        let stored = stash.variant("depth_map.smoothing", "Some").expect("kept");
        restored.smoothing.apply(stored);
        assert_eq!(restored, map);
        assert_eq!(kept(&with(Some(map)), &with(None)).depth_map(), Some(map));
    }
}
