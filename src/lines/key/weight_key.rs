//! Which factors of width and opacity are compiled into the passes.

use crate::lines::settings::Outlines;

/// Which factors of width and opacity are not 1: what selects the variants of the passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct WeightKey {
    pub kinds: bool,
    /// Silhouettes in front of other objects differ from those in front of the same.
    pub outer: bool,
    pub light: bool,
    pub perspective: bool,
    pub nib_roundness: bool,
    pub taper: bool,
    /// The widths that are drawn with object ids: pressure, and those of vertices.
    pub map: bool,
    /// Lines are thinner where they crowd.
    pub budget: bool,
    /// Lines fade into fog.
    pub fog: bool,
    /// Lines fade out of focus.
    pub focus: bool,
    /// Near, middle and far have lines of their own; their borders are found; whole objects are
    /// in one of them.
    pub layers: bool,
    pub found_borders: bool,
    pub by_objects: bool,
    /// Creases are fainter where the picture is abstract.
    pub abstracts: bool,
}

impl WeightKey {
    pub fn new(lines: &Outlines) -> Self {
        let weight = &lines.weight;
        let kinds = [weight.outer, weight.inner, weight.crease, weight.object];
        Self {
            kinds: kinds != [1.0; 4],
            outer: weight.reads_ids(),
            light: weight.reads_normals(),
            perspective: weight.perspective > 0.0,
            nib_roundness: weight.nib_roundness < 1.0 && lines.smooth,
            taper: weight.taper > 0.0,
            budget: lines.ink_budget < 1.0,
            ..Self::default()
        }
    }

    /// Whether any factor is not 1, those of the budget, the fog and the focus included.
    pub fn any(self) -> bool {
        self.kinds
            || self.budget
            || self.fog
            || self.focus
            || self.layers
            || self.abstracts
            || self.varies()
    }

    /// Whether the width changes along a line. Where lines crowd, a shift of half a pixel
    /// cannot be seen.
    pub fn varies(self) -> bool {
        self.light || self.perspective || self.nib_roundness || self.taper || self.map
    }
}
