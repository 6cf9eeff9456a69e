//! Plans of views that lack a prepass, and of devices that lack what effects use.

use crate::effect::Needs;

use super::{Plan, Planned, device::DeviceLacks};
use crate::{
    composite::{BeyondPrepass, DebugView, OwnPixels},
    diagnostics::SkipReason,
};

/// Inputs that a view may lack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Input {
    DepthPrepass,
    NormalPrepass,
    ObjectIds,
}

impl Plan {
    /// The plan on a device.
    #[must_use]
    pub fn on_device(mut self, lacks: DeviceLacks) -> Self {
        self.lacks = lacks;
        if lacks.depth_copies {
            self.beyond = BeyondPrepass::Styled;
        }
        if lacks.object_ids {
            self.without(Input::ObjectIds)
        } else {
            self.resolve();
            self
        }
    }

    /// The plan for a view that does not have this input, or does not have it yet.
    #[must_use]
    pub fn without(&self, missing: Input) -> Self {
        let mut plan = self.clone();
        let (needs, reason) = match missing {
            Input::DepthPrepass => (
                Needs::all().difference(Needs::WITHOUT_PREPASSES),
                SkipReason::NoDepthPrepass,
            ),
            Input::NormalPrepass => (Needs::NORMALS, SkipReason::NoNormalPrepass),
            Input::ObjectIds => (Needs::IDS, SkipReason::NoStorageBuffers),
        };
        for planned in std::mem::take(&mut plan.effects) {
            let name = planned.effect.name();
            match planned.effect.any_without(needs) {
                Some(effect)
                    if effect.any_strength() > 0.0 && !effect.any_needs().intersects(needs) =>
                {
                    plan.effects.push(Planned { effect, ..planned });
                }
                _ => plan.left_out.push((name, reason)),
            }
        }
        match missing {
            Input::DepthPrepass => {
                plan.view = plan.view.filter(|v| !v.needs_depth());
                plan.histogram = false;
                plan.readback = false;
                plan.objects.unstyled = false;
                plan.own_pixels = None;
                plan.beyond = BeyondPrepass::Styled;
            }
            Input::NormalPrepass => {
                plan.view = plan.view.filter(|v| *v != DebugView::Creases);
            }
            Input::ObjectIds => {
                plan.view = plan.view.filter(|v| !v.reads_ids());
                plan.lacks.object_ids = true;
                plan.objects.any = false;
                plan.objects.widths = false;
                plan.objects.unstyled = false;
                plan.objects.anchored = false;
                plan.objects.highlights = false;
                plan.own_pixels = plan.own_pixels.map(|_| OwnPixels::Depth);
            }
        }
        plan.resolve();
        plan
    }
}

#[cfg(all(test, feature = "objects"))]
mod tests {
    use bevy::ecs::world::World;

    use super::*;
    use crate::{
        effect::EffectRegistry,
        lines::{CreaseSource, Creases, Outlines},
        objects::ObjectChanges,
    };

    /// Creases at the edges of meshes need triangles with numbers; elsewhere they are found in normals.
    #[test]
    fn creases_are_those_of_normals_where_triangles_have_no_numbers() {
        let creases = Creases {
            source: CreaseSource::Meshes,
            ..Creases::default()
        };
        let mut world = World::new();
        let camera = world.spawn(Outlines {
            creases: Some(creases),
            ..Outlines::default()
        });
        let camera = camera.id();
        let types = EffectRegistry::built_in().types();
        for primitive_index in [false, true] {
            let lacks = DeviceLacks {
                primitive_index,
                ..DeviceLacks::default()
            };
            let plan = Plan::new(world.entity(camera), &[], &types, ObjectChanges::default());
            let plan = plan.expect("outlines").on_device(lacks);
            assert_eq!(plan.needs_normals(), primitive_index);
        }
    }
}
