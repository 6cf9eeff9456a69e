//! The depth map as a function of distance.

use bevy::prelude::*;

use super::{DepthMap, ProjectionKind, frame::DepthProjection};

/// Where distances along the view's axis, in world units, are in a view's depth map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthAxis {
    /// The distance with D = 0.
    near: f64,
    scale: Scale,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    /// The distance from D = 0 to D = 1.
    Linear(f64),
    /// The logarithm of the ratio of the distances at D = 1 and D = 0; and the distance that
    /// smaller ones count as.
    Logarithmic { octaves: f64, least: f64 },
}

impl DepthAxis {
    /// The axis of a camera's map.
    ///
    /// `clip_from_view` is [`Camera::clip_from_view`],
    /// `projection` the camera's component, if it has one, and `visible` the distances of the near
    /// and the far end of the visible range, such as
    /// [`DepthHistogram::drawn`](super::DepthHistogram::drawn). Returns `None` if the map depends
    /// on the visible range and that is not known, or if the map tells no distances apart.
    pub fn new(
        map: &DepthMap,
        clip_from_view: &Mat4,
        projection: Option<&Projection>,
        visible: Option<(f32, f32)>,
    ) -> Option<Self> {
        let map = map.sanitized();
        Self::of(
            &map,
            &DepthProjection::new(clip_from_view, projection),
            visible,
        )
    }

    fn of(map: &DepthMap, projection: &DepthProjection, seen: Option<(f32, f32)>) -> Option<Self> {
        let frame = projection.frame(map);
        let (near, far) = if map.mapping.follows_visible_range() {
            let (near, far) = seen?;
            (f64::from(near), f64::from(far))
        } else {
            (
                projection.distance(frame.near),
                projection.distance(frame.far),
            )
        };
        let is_orthographic = projection.kind() == ProjectionKind::Orthographic;
        // The smallest range that fills the map, see `spread_floor` of `map.wgsl`.
        let (is_floored, floored) = if is_orthographic {
            let floor = f64::from(map.orthographic_floor);
            (far - near <= floor, floor)
        } else {
            let floor = f64::from(map.floor);
            (1.0 - near / far <= floor, floor * far)
        };
        let least = if is_orthographic {
            1e-4 * f64::from(frame.extent)
        } else {
            0.0
        };
        let scale = if is_floored {
            Scale::Linear(floored)
        } else if map.mapping.is_logarithmic() {
            Scale::Logarithmic {
                octaves: (far.max(least) / near.max(least)).log2(),
                least,
            }
        } else {
            Scale::Linear(far - near)
        };
        let axis = Self { near, scale };
        axis.is_sound().then_some(axis)
    }

    /// Whether it tells distances apart.
    fn is_sound(&self) -> bool {
        let size = match self.scale {
            Scale::Linear(length) => length,
            Scale::Logarithmic { octaves, .. } => octaves,
        };
        self.near.is_finite() && size.is_finite() && size > 0.0
    }

    /// `D` at a distance, 0 to 1.
    pub fn place(&self, distance: f64) -> f64 {
        let d = match self.scale {
            Scale::Linear(length) => (distance - self.near) / length,
            Scale::Logarithmic { octaves, least } => {
                (distance.max(least) / self.near.max(least)).log2() / octaves
            }
        };
        d.clamp(0.0, 1.0)
    }

    /// The distance at `D`.
    pub fn distance(&self, d: f64) -> f64 {
        match self.scale {
            Scale::Linear(length) => self.near + d * length,
            Scale::Logarithmic { octaves, least } => self.near.max(least) * (d * octaves).exp2(),
        }
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::DepthMapping;

    fn perspective() -> DepthProjection {
        let projection = Projection::Perspective(PerspectiveProjection {
            near: 0.5,
            far: 800.0,
            ..Default::default()
        });
        let matrix = Mat4::perspective_rh(1.0, 1.0, 800.0, 0.5);
        DepthProjection::new(&matrix, Some(&projection))
    }

    fn orthographic() -> DepthProjection {
        let projection = OrthographicProjection {
            near: 0.0,
            far: 800.0,
            ..OrthographicProjection::default_3d()
        };
        let matrix = Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, 800.0, 0.0);
        DepthProjection::new(&matrix, Some(&Projection::Orthographic(projection)))
    }

    /// D at a distance from raw depths, as `map.wgsl` has it.
    fn from_raw(map: &DepthMap, projection: &DepthProjection, seen: (f32, f32), z: f64) -> f64 {
        let raw = |z: f64| projection.raw_depth(z);
        let frame = projection.frame(map);
        let (near, far) = if map.mapping.follows_visible_range() {
            (raw(f64::from(seen.0)), raw(f64::from(seen.1)))
        } else {
            (f64::from(frame.near), f64::from(frame.far))
        };
        let offset = f64::from(projection.offset());
        let is_orthographic = projection.kind() == ProjectionKind::Orthographic;
        let floor = if is_orthographic {
            f64::from(frame.floor)
        } else {
            f64::from(frame.floor) * (near + offset)
        };
        let d = raw(z);
        let whole = near - far;
        if map.mapping.is_logarithmic() && whole > floor {
            let log = |d: f64| {
                if is_orthographic {
                    let extent = f64::from(frame.extent);
                    -(f64::from(frame.plane_far) - d * extent)
                        .max(1e-4 * extent)
                        .log2()
                } else {
                    (d + offset).log2()
                }
            };
            return ((log(near) - log(d)) / (log(near) - log(far))).clamp(0.0, 1.0);
        }
        let linear = (near - d) / whole.max(floor);
        let linear = if is_orthographic {
            linear
        } else {
            linear * (far + offset) / (d + offset)
        };
        linear.clamp(0.0, 1.0)
    }

    #[test]
    fn places_are_those_of_the_depth_map_and_have_their_distances() {
        let mappings = [
            DepthMapping::MinMax,
            DepthMapping::MinMaxLogarithmic,
            DepthMapping::Linear,
            DepthMapping::Logarithmic,
            DepthMapping::Fixed {
                from: 3.0,
                to: 90.0,
            },
            DepthMapping::FixedLogarithmic {
                from: 3.0,
                to: 90.0,
            },
        ];
        let ranges = [(2.0, 300.0), (40.0, 41.0), (40.0, 40.001)];
        for projection in [perspective(), orthographic()] {
            for mapping in mappings {
                for seen in ranges {
                    let map = DepthMap {
                        mapping,
                        orthographic_floor: 0.01,
                        ..DepthMap::default()
                    };
                    let axis = DepthAxis::of(&map, &projection, Some(seen)).expect("known");
                    for step in 0..=20 {
                        let z = 0.6 * 1000f64.powf(f64::from(step) / 20.0);
                        let place = axis.place(z);
                        let raw = from_raw(&map, &projection, seen, z);
                        // A frame is in single precision: 2^-24 of 800 units under the
                        // orthographic projection, as a fraction of 87 units or more.
                        assert!(
                            (place - raw).abs() < 1e-6,
                            "{:?}, {mapping:?}, {seen:?}: {z} is at {place}, not at {raw}",
                            projection.kind()
                        );
                        if place > 0.0 && place < 1.0 {
                            let back = axis.distance(place);
                            assert!((back / z - 1.0).abs() < 1e-9, "{z} became {back}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn an_unknown_range_or_an_empty_one_has_no_places() {
        let map = DepthMap::default();
        assert_eq!(DepthAxis::of(&map, &perspective(), None), None);
        let one = Some((7.0, 7.0));
        let flat = DepthMap { floor: 0.0, ..map };
        assert_eq!(DepthAxis::of(&flat, &perspective(), one), None);
        assert_eq!(
            DepthAxis::of(&map, &perspective(), Some((f32::NAN, 1.0))),
            None
        );
        let infinite = Some((1.0, f32::INFINITY));
        assert_eq!(DepthAxis::of(&map, &perspective(), infinite), None);
    }
}
