//! The borders of `DepthLayers` in the histogram of depths, which can be dragged.

use bevy::prelude::*;
use bevy_egui::egui::{CursorIcon, EventFilter, Id, Key, Pos2, Rect, Response, Sense, Ui};

use super::{Widgets, note};
use bevy_comics::{
    ComicStyle, DepthLayers,
    depth::{DepthAxis, DepthHistogram},
    effects::LayerBorders,
};

/// Half the width of what can be grabbed of a border, in points.
const GRIP: f32 = 6.0;

/// What an arrow key moves a border by, as a fraction of the depth map.
const STEP: f64 = 0.01;

const NAMES: [&str; 2] = ["end of near", "start of far"];

/// The borders of a camera's `DepthLayers`.
pub struct PlaneCuts {
    layers: DepthLayers,
    axis: DepthAxis,
    /// Distances of the end of near and of the start of far, in world units.
    pub distances: [f64; 2],
}

impl PlaneCuts {
    /// The borders that a camera with this style has; `None` if it has none, or if they are not
    /// known yet.
    pub fn of(
        world: &World,
        camera: Entity,
        style: &ComicStyle,
        histogram: &DepthHistogram,
    ) -> Option<Self> {
        let layers = *style.get::<DepthLayers>()?;
        let clip_from_view = world.get::<Camera>(camera)?.clip_from_view();
        let projection = world.get::<Projection>(camera);
        let map = style.depth_map.unwrap_or_default();
        let axis = DepthAxis::new(&map, &clip_from_view, projection, histogram.drawn)?;
        let fixed = [
            layers.foreground_end,
            layers.background_start.max(layers.foreground_end),
        ];
        let found = histogram
            .borders
            .filter(|_| layers.borders == LayerBorders::Auto);
        let distances = match found {
            Some((near_end, far_start)) => [near_end, far_start].map(f64::from),
            None => fixed.map(|d| axis.distance(f64::from(d))),
        };
        Some(Self {
            layers,
            axis,
            distances,
        })
    }

    /// The layers with one border at a distance, which pushes the other one along where they meet.
    fn with(&self, moved: usize, distance: f64) -> DepthLayers {
        let mut places = self.distances.map(|distance| self.axis.place(distance));
        let place = self.axis.place(distance);
        places = if moved == 0 {
            [place, places[1].max(place)]
        } else {
            [places[0].min(place), place]
        };
        DepthLayers {
            borders: LayerBorders::Fixed,
            foreground_end: places[0] as f32,
            background_start: places[1] as f32,
            ..self.layers
        }
    }

    /// Lets both borders be moved, by the pointer and by the arrow keys. `plot`: where the chart
    /// is; `x_of` and `distance_of`: from distances to places on the screen and back.
    pub fn drag(
        &self,
        ui: &Ui,
        (plot, x_of, distance_of): (Rect, impl Fn(f64) -> f32, impl Fn(f32) -> f64),
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
        for (border, name) in NAMES.into_iter().enumerate() {
            let x = x_of(self.distances[border]).clamp(plot.left(), plot.right());
            let rect = Rect::from_min_max(
                Pos2::new(x - GRIP, plot.top()),
                Pos2::new(x + GRIP, plot.bottom()),
            );
            let id = Id::new(("layer_border", border));
            let grip = ui.interact(rect, id, Sense::click_and_drag());
            note(widgets, format!("border.{border}"), &grip);
            let place = self.axis.place(self.distances[border]);
            let moved = match grip.interact_pointer_pos() {
                Some(at) if grip.dragged() => Some(distance_of(at.x)),
                _ => step(ui, &grip).map(|steps| self.axis.distance(place + STEP * steps)),
            };
            if let Some(distance) = moved {
                style.insert(self.with(border, distance));
            }
            if grip.has_focus() {
                let color = ui.style().visuals.selection.stroke;
                ui.painter()
                    .rect_stroke(rect, 0.0, color, bevy_egui::egui::StrokeKind::Inside);
            }
            grip.on_hover_cursor(CursorIcon::ResizeHorizontal)
                .on_hover_text(format!(
                    "{name}, D = {place:.3}. Drag it to fix both borders."
                ));
        }
    }
}

/// The steps of the arrow keys in this frame, to the right; `None` without the focus or without
/// a key.
fn step(ui: &Ui, response: &Response) -> Option<f64> {
    if !response.has_focus() {
        return None;
    }
    // Otherwise the arrow keys would move the focus to another widget.
    ui.memory_mut(|memory| {
        let filter = EventFilter {
            horizontal_arrows: true,
            ..EventFilter::default()
        };
        memory.set_focus_lock_filter(response.id, filter);
    });
    let pressed = |key| ui.input(|input| f64::from(u8::from(input.key_pressed(key))));
    let steps = pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
    (steps != 0.0).then_some(steps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_comics::{DepthMap, DepthMapping};

    #[test]
    fn a_border_that_is_moved_is_fixed_and_pushes_the_other() {
        let map = DepthMap {
            mapping: DepthMapping::Fixed {
                from: 1.0,
                to: 101.0,
            },
            ..DepthMap::default()
        };
        let matrix = Mat4::perspective_infinite_reverse_rh(1.0, 1.0, 0.1);
        let cuts = PlaneCuts {
            layers: DepthLayers::default(),
            axis: DepthAxis::new(&map, &matrix, None, None).expect("fixed"),
            distances: [21.0, 61.0],
        };
        let moved = |border, distance| {
            let layers = cuts.with(border, distance);
            assert_eq!(layers.borders, LayerBorders::Fixed);
            [layers.foreground_end, layers.background_start].map(|d| (d * 1000.0).round() / 1000.0)
        };
        assert_eq!(moved(0, 31.0), [0.3, 0.6]);
        assert_eq!(moved(1, 81.0), [0.2, 0.8]);
        assert_eq!(moved(0, 71.0), [0.7, 0.7]);
        assert_eq!(moved(1, 11.0), [0.1, 0.1]);
        assert_eq!(moved(0, -5.0), [0.0, 0.6]);
        assert_eq!(moved(1, f64::INFINITY), [0.2, 1.0]);
    }
}
