//! What an effect reads.

use bitflags::bitflags;

bitflags! {
    /// The inputs that an effect's WGSL reads besides the color of its pixel.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct Needs: u32 {
        /// The depth map at the pixel, in `Pixel::depth`. Runs the depth prepass,
        /// and the search for the visible range if the map follows it.
        const MAP = 1;
        /// Raw depth at any pixel, by `bevy_comics::depth::view::load_depth`. Runs
        /// the depth prepass.
        const DEPTH = 1 << 1;
        /// World-space normals at any pixel, by
        /// `bevy_comics::depth::normal::load_normal`. Runs the depth prepass and the
        /// normal prepass.
        const NORMALS = 1 << 2;
        /// Object ids at any pixel, by `bevy_comics::objects::load_object`. Runs the
        /// depth prepass and the pass that draws ids. Needs the crate's feature
        /// `objects`.
        const IDS = 1 << 3;
        /// The lines at the pixel, by `bevy_comics::lines::read::lines_at`. The
        /// effect is left out if no effect of the camera requests lines.
        const LINES = 1 << 4;
        /// The lines at any place, read several times per pixel. Includes
        /// [`Needs::LINES`].
        const LINES_ANYWHERE = 1 << 5;
        /// The change of the unstyled picture's lightness over a pixel, in
        /// `Pixel::change`.
        const LIGHTNESS_CHANGE = 1 << 6;
        /// The picture after all effects before this one, at any place, by
        /// `bevy_comics::effect::picture::load_picture` and `picture_at`. Divides the
        /// fused pass in two at this effect: the first one draws a texture of the
        /// viewport's size in 16-bit floating-point numbers. `Pixel::saturation` is 1 again
        /// in the second one.
        const PICTURE = 1 << 7;
        /// A tile of thresholds in an even, irregular order, by
        /// `bevy_comics::effect::blue_noise::blue_noise`.
        const BLUE_NOISE = 1 << 8;
        /// Means and variances of that picture over boxes of any size around every pixel, by
        /// `bevy_comics::effect::box_statistics::load_means`. Includes [`Needs::PICTURE`]. Two
        /// passes draw them, to two textures of the viewport's size with 16 bytes a pixel. The WGSL
        /// says how large the boxes are, see [`Effect::HALF_BOX`](super::Effect::HALF_BOX).
        const BOX_STATISTICS = 1 << 9;
        /// Where the object at a pixel is, by `load_object` and `style_of` of
        /// `bevy_comics::objects`, if it has a [`PatternAnchor`](crate::objects::PatternAnchor).
        /// Includes
        /// [`Needs::IDS`] while some object has one; otherwise it asks for nothing, and
        /// `OBJECT_ANCHORS` is not defined in WGSL.
        const OBJECT_ANCHORS = 1 << 10;
        /// That picture together with a number of the effect's own at every pixel, by
        /// `bevy_comics::effect::aux_scalar::load_aux_scalar`: both by one load, for effects that
        /// would read the depth of many pixels besides their colors. In place of
        /// [`Needs::PICTURE`]: the first pass draws a texture of the viewport's size with 16
        /// bytes a pixel, which holds both. The WGSL says what the number is, see
        /// [`Effect::AUX_SCALAR`](super::Effect::AUX_SCALAR). An effect that also has
        /// [`Needs::BOX_STATISTICS`] gets only the statistics.
        const AUX_SCALAR = 1 << 11;
        /// The two depths that divide what is visible into near, middle and far, by
        /// `bevy_comics::depth::view::depth_borders`. Counts the depths, and finds the borders in
        /// a pass. Without compute shaders, and with
        /// [`ReductionMethod::PingPong`](crate::depth::ReductionMethod::PingPong), there are none.
        const DEPTH_BORDERS = 1 << 12;
        /// The depth of every object in the depth map, by `bevy_comics::objects::object_depth`.
        /// Includes [`Needs::IDS`]. Without the crate's feature `objects` it asks for nothing, and
        /// `OBJECT_DEPTHS` is not defined in WGSL.
        const OBJECT_DEPTHS = 1 << 13;
        /// The raw depth in the middle of the view, by `bevy_comics::depth::view::middle_depth`: the
        /// median of 25 places in a square of 2 % of the view's height, with a time constant of 0.15
        /// s; 0 where there is sky. Without compute shaders it asks for nothing, and `MIDDLE_DEPTH` is
        /// not defined in WGSL.
        const MIDDLE_DEPTH = 1 << 14;
        /// The true place of the world: `WORLD_ORIGIN` is defined in WGSL while the app has a
        /// [`WorldOrigin`](crate::cameras::WorldOrigin), see [`EffectContext`](super::EffectContext).
        const WORLD_ORIGIN = 1 << 15;
        /// Tones that do not depend on the exposure: the effect divides the picture by its
        /// lightness, or shades or prints by it. By itself this asks for nothing; it lets a
        /// [`ToneRange`](crate::ToneRange) of the camera apply.
        const TONES = 1 << 16;
    }
}

impl Needs {
    /// What every view can provide.
    pub(crate) const WITHOUT_PREPASSES: Self = Self::LIGHTNESS_CHANGE
        .union(Self::PICTURE)
        .union(Self::BLUE_NOISE)
        .union(Self::BOX_STATISTICS)
        .union(Self::AUX_SCALAR)
        .union(Self::WORLD_ORIGIN)
        .union(Self::TONES);
}
