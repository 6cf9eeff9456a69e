//! The unit of lengths: logical pixels, or page pixels, which are relative to the height of the view.

use bevy::prelude::*;

use crate::settings::{FieldRange, clamp_or_default};

/// On a camera: the height of its view in page pixels. Lengths of its effects, its lines and the toon
/// materials that it sees are page pixels, so the view is the same drawing at every size. Without
/// this component, they are logical pixels, and physical ones in materials.
///
/// A page pixel is the height of the view divided by this number, but at least 0.5 and at most 4
/// logical pixels. The view is the camera's own viewport; of a
/// [`SubCameraView`](bevy::camera::SubCameraView), it is the whole that it is a part of. A picture
/// with a larger [scale factor](bevy::camera::ImageRenderTarget::scale_factor) has the lengths of the
/// window, enlarged. Cells of screens are at least 2.5 physical pixels wide.
///
/// Toon materials tell views apart by viewport, place, axis and projection. Of views that are equal
/// in all of these, in two windows for example, they use the page of one for all.
///
/// [`ComicStyle::page`](crate::ComicStyle::page) sets this component, and a complete style without
/// a page removes it, until the style is taken off.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct PageHeight(
    /// Height of the view in page pixels. Range 90 to 4320, default 540.
    #[reflect(@FieldRange::logarithmic(90.0, 4320.0).unit("px"))]
    pub f32,
);

impl Default for PageHeight {
    fn default() -> Self {
        Self(540.0)
    }
}

impl PageHeight {
    /// The height that is used: clamped to its range, 540 if it is not finite.
    #[must_use]
    pub fn sanitized(self) -> Self {
        Self(clamp_or_default(self.0, Self::default().0, 90.0, 4320.0))
    }
}

/// Multiplies the lengths in logical and page pixels of all cameras: a setting for players who want
/// wider lines and larger dots. Range 0.25 to 4, default 1; 1 if it is not finite.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default, Clone, PartialEq)]
pub struct PageScale(pub f32);

impl Default for PageScale {
    fn default() -> Self {
        Self(1.0)
    }
}

impl PageScale {
    fn factor(self) -> f32 {
        clamp_or_default(self.0, 1.0, 0.25, 4.0)
    }
}

/// The least and the most logical pixels of a page pixel.
const LOGICAL: [f32; 2] = [0.5, 4.0];

/// What the lengths of a view are multiplied by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LengthScale {
    /// Physical pixels per unit of length.
    pub factor: f32,
    /// The unit is a page pixel, else a logical one.
    pub has_page: bool,
}

impl LengthScale {
    pub fn new(camera: &Camera, page: Option<&PageHeight>, players: PageScale) -> Self {
        let per_logical = camera.target_scaling_factor().unwrap_or(1.0);
        let players = players.factor();
        let height = page.and_then(|page| Some((page.sanitized().0, whole_height(camera)?)));
        let Some((page, height)) = height else {
            return Self {
                factor: players * per_logical,
                has_page: false,
            };
        };
        let [least, most] = LOGICAL.map(|pixels| pixels * per_logical);
        // Not `clamp`, which panics if a scale factor is no number.
        Self {
            factor: players * (height / page).max(least).min(most),
            has_page: true,
        }
    }
}

/// The height in physical pixels of a camera's view, or of the whole that it is a part of.
fn whole_height(camera: &Camera) -> Option<f32> {
    let height = camera.physical_viewport_size()?.y as f32;
    let part = camera
        .sub_camera_view
        .filter(|part| part.full_size.y > 0 && part.size.y > 0);
    Some(part.map_or(height, |part| {
        height * (part.full_size.y as f32 / part.size.y as f32)
    }))
}

#[cfg(test)]
mod tests {
    use bevy::camera::{ComputedCameraValues, RenderTargetInfo, SubCameraView, Viewport};

    use super::*;
    use crate::{ComicStyle, Vignette, effect::EffectRegistry};

    fn camera(physical_size: UVec2, scale_factor: f32) -> Camera {
        let target_info = Some(RenderTargetInfo {
            physical_size,
            scale_factor,
        });
        Camera {
            computed: ComputedCameraValues {
                target_info,
                ..default()
            },
            ..default()
        }
    }

    /// Physical pixels of a page pixel, of 540 in the height.
    fn scale(camera: &Camera) -> f32 {
        let page = PageHeight::default();
        LengthScale::new(camera, Some(&page), PageScale::default()).factor
    }

    #[test]
    fn page_pixels_are_parts_of_the_height_of_the_view() {
        let full_hd = UVec2::new(1920, 1080);
        for (size, scale_factor, want) in [
            (UVec2::new(960, 540), 1.0, 1.0),
            (full_hd, 1.0, 2.0),
            (full_hd, 2.0, 2.0),
            (UVec2::new(480, 270), 1.0, 0.5),
            // At least half a logical pixel, and at most 4.
            (UVec2::new(160, 90), 1.0, 0.5),
            (full_hd, 8.0, 4.0),
            (UVec2::new(7680, 4320), 1.0, 4.0),
            // A photograph of eight times the size.
            (full_hd * 8, 8.0, 16.0),
            (UVec2::ZERO, 1.0, 0.5),
        ] {
            let found = scale(&camera(size, scale_factor));
            assert_eq!(found, want, "{size} at {scale_factor}");
        }
        let mut lower = camera(full_hd, 1.0);
        lower.viewport = Some(Viewport {
            physical_size: UVec2::new(1920, 540),
            ..default()
        });
        assert_eq!(scale(&lower), 1.0, "a player's half");
        // A quarter of a picture: the whole has twice the height.
        let tile = |size| SubCameraView {
            full_size: UVec2::new(32, 18),
            size,
            ..default()
        };
        let mut quarter = camera(full_hd, 2.0);
        quarter.sub_camera_view = Some(tile(UVec2::new(16, 9)));
        assert_eq!(scale(&quarter), 4.0);
        quarter.sub_camera_view = Some(tile(UVec2::ZERO));
        assert_eq!(scale(&quarter), 2.0);
    }

    #[test]
    fn without_a_page_lengths_are_logical_pixels() {
        let camera = camera(UVec2::new(1920, 1080), 1.5);
        let page = PageHeight(1080.0);
        for (players, want) in [(1.0, 1.0), (2.0, 2.0), (0.0, 0.25), (f32::INFINITY, 1.0)] {
            let of = |page| LengthScale::new(&camera, page, PageScale(players));
            let (none, paged) = (of(None), of(Some(&page)));
            assert_eq!((none.factor, none.has_page), (1.5 * want, false));
            assert_eq!((paged.factor, paged.has_page), (want, true));
        }
    }

    #[test]
    fn pages_are_clamped() {
        for (page, used) in [
            (0.0, 90.0),
            (-1.0, 90.0),
            (1e9, 4320.0),
            (f32::NAN, 540.0),
            (f32::INFINITY, 540.0),
        ] {
            let style = ComicStyle::new().with_page(page).sanitized();
            assert_eq!(style.page, Some(used), "{page}");
        }
        assert_eq!(ComicStyle::new().sanitized().page, None);
    }

    #[test]
    fn pages_are_part_of_files_and_lie_over_others() {
        let paged = ComicStyle::from_ron("(version: 3, page: 540)").expect("readable");
        assert_eq!(paged, ComicStyle::new().with_page(540.0));
        let again = ComicStyle::from_ron(&paged.to_ron().expect("text"));
        assert_eq!(again.expect("readable"), paged);
        // A partial style keeps the page that it does not mention.
        let partial = ComicStyle::new().with(Vignette::default()).partial();
        assert_eq!(partial.over(&paged).page, Some(540.0));
        let other = partial.clone().with_page(720.0);
        assert_eq!(other.over(&paged).page, Some(720.0));
        assert_eq!(ComicStyle::new().over(&paged).page, None);
    }

    #[test]
    fn pages_are_blended_by_ratio() {
        let paged = |page| ComicStyle::new().with_page(page);
        let (small, large) = (paged(270.0), paged(1080.0));
        let between = small.blend(&large, 0.5).page.expect("a page");
        assert!((between - 540.0).abs() < 0.1, "{between}");
        for (t, want) in [(0.49, Some(270.0)), (0.51, None)] {
            assert_eq!(small.blend(&ComicStyle::new(), t).page, want);
            assert_eq!(ComicStyle::new().blend(&small, 1.0 - t).page, want);
        }
    }

    #[test]
    fn a_camera_has_the_page_of_its_style_and_then_its_own_again() {
        let mut world = World::new();
        world.insert_resource(EffectRegistry::default());
        let camera = world.spawn(PageHeight(360.0)).id();
        let apply = |world: &mut World, style: &ComicStyle| {
            style.apply(&mut world.commands().entity(camera));
            world.flush();
            world.get::<PageHeight>(camera).map(|page| page.0)
        };
        let partial = ComicStyle::new().partial();
        assert_eq!(apply(&mut world, &partial), Some(360.0));
        let paged = ComicStyle::new().with_page(540.0);
        assert_eq!(apply(&mut world, &paged), Some(540.0));
        assert_eq!(apply(&mut world, &ComicStyle::new()), None);
        // What a partial style does not mention is the game's.
        assert_eq!(apply(&mut world, &partial), Some(360.0));
        world.entity_mut(camera).insert(PageHeight(720.0));
        assert_eq!(apply(&mut world, &paged), Some(540.0));
        ComicStyle::remove_from(&mut world.commands().entity(camera));
        world.flush();
        assert_eq!(world.get(camera), Some(&PageHeight(720.0)));
    }
}
