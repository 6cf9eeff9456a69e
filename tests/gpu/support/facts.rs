//! What is known of each feature with each effect: the one table behind `docs/support.md`.
//!
//! A test that draws an effect with a feature is one more line of [`FACTS`]. Lines can be in any order:
//! a cell names all tests that have a line for it.

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    Vulkan,
    Metal,
    Direct3D12,
    WebGpu,
    OpenGl,
    WebGl2,
    NoCompute,
    Msaa1,
    Msaa2,
    Msaa4,
    Msaa8,
    Hdr,
    Taa,
    Fxaa,
    Smaa,
    Resolution,
    Deferred,
    Orthographic,
    Oblique,
    OffCentre,
    Viewport,
    SplitScreen,
    SeveralCameras,
    Texture,
    Transparent,
    Skinned,
    Morphed,
    Instanced,
    OwnPipeline,
}

/// How an answer is known.
#[derive(Clone, Copy, Debug)]
pub enum Known {
    /// The test that draws it, as `module::function`.
    Run(&'static str),
    /// Those tests of `pairwise` in whose rows it is.
    Pairs,
    /// `scripts/translate` translates its shaders.
    Translated,
    /// What happens instead.
    NotSupported(&'static str),
    Unknown,
}

/// Columns of one table.
pub struct Group {
    pub title: &'static str,
    pub note: &'static str,
    /// With the heads of their columns.
    pub features: &'static [(Feature, &'static str)],
}

use Feature::*;
use Known::*;

pub const GROUPS: &[Group] = &[
    Group {
        title: "Platforms",
        note: "\
naga translates every shader to SPIR-V, MSL (Metal), HLSL (Direct3D 12) and GLSL ES 3.10 (OpenGL). `spirv-val` checks
the SPIR-V and `glslangValidator` the GLSL; no compiler of Apple or Microsoft has seen the MSL and the HLSL. Headless
Chromium reads them as shader modules of WebGPU, makes no pipelines, and draws nothing. It is not given sections, which need
`primitive_index`, and refuses materials under an environment map, in which naga 29 writes a constant of the engine that is
no `f32`. GLSL ES 3.10 has no translations of art maps (levels of a texture), of materials (depth prepass, shadow maps, arrays
of bindings) and of multisampled object ids. \"GL\" is Mesa's OpenGL 4.5 on the CPU; what is left out there is in
[troubleshooting](troubleshooting.md#opengl). On WebGL2 itself, nothing was run; \"no compute\" is a device of Vulkan and of
OpenGL with the limits of WebGL2: no compute shaders, no storage buffers.",
        features: &[
            (Vulkan, "Vulkan"),
            (Metal, "Metal"),
            (Direct3D12, "DX12"),
            (WebGpu, "WebGPU"),
            (OpenGl, "GL"),
            (WebGl2, "WebGL2"),
            (NoCompute, "no compute"),
        ],
    },
    Group {
        title: "Samples and storage of the picture",
        note: "\
lavapipe has 1 and 4 samples, so nothing was drawn with 2 or 8. Multisampled shaders differ by a number only; those of 4 samples
were translated.",
        features: &[
            (Msaa1, "1 sample"),
            (Msaa2, "2 samples"),
            (Msaa4, "4 samples"),
            (Msaa8, "8 samples"),
            (Hdr, "HDR"),
        ],
    },
    Group {
        title: "Anti-aliasing and the main pass",
        note: "\
\"Resolution\" is a main pass of a lower resolution than the picture (`MainPassResolutionOverride`), as with upscalers.",
        features: &[
            (Taa, "TAA"),
            (Fxaa, "FXAA"),
            (Smaa, "SMAA"),
            (Resolution, "resolution"),
            (Deferred, "deferred"),
        ],
    },
    Group {
        title: "Projections",
        note: "\
All effects are tested in perspective views. The depth range is also tested with oblique near planes, without an effect
(`range_views::distances_are_right_under_every_projection`). \"Off-centre\" is a part of a larger view (`sub_camera_view`)
or another frustum that is not symmetric.",
        features: &[
            (Orthographic, "orthographic"),
            (Oblique, "oblique"),
            (OffCentre, "off-centre"),
        ],
    },
    Group {
        title: "Cameras",
        note: "\
\"Viewport\" is one camera that draws into a part of its target, \"split screen\" two such cameras on one target. \"Several
cameras\" have the effect at the same time, on one target or on two. Each draws what it draws alone. \"Texture\" is a camera
that draws into an image, as in all tests but those of the panel.",
        features: &[
            (Viewport, "viewport"),
            (SplitScreen, "split screen"),
            (SeveralCameras, "several cameras"),
            (Texture, "texture"),
        ],
    },
    Group {
        title: "Meshes",
        note: "\
\"Transparent\" is a blended mesh with `DepthWrite`; without it, the effect sees what is behind the mesh. \"Instanced\" are
meshes that the engine draws together, \"own pipeline\" instances that a pipeline of the game draws. Blended, skinned, morphed
and instanced meshes are drawn as plain meshes of the same shape and colour are.",
        features: &[
            (Transparent, "transparent"),
            (Skinned, "skinned"),
            (Morphed, "morphed"),
            (Instanced, "instanced"),
            (OwnPipeline, "own pipeline"),
        ],
    },
];

/// Every effect.
const ALL: &[&str] = &[];

/// The effects that presets use and that the reference of the whole picture draws.
pub const OF_PRESETS: &[&str] = &[
    "tone_ramp",
    "tone_bands",
    "desaturation",
    "colorization",
    "color_harmony",
    "depth_layers",
    "misregistration",
    "halftone",
    "black_flats",
    "contours",
    "outlines",
    "sketch",
    "paper",
    "vignette",
];

/// Effects of looks that the reference of the whole picture does not draw.
pub const OF_LOOKS: &[&str] = &["hatching", "iso_lines"];

/// `full_style` of `failures/mod.rs`.
const FIRST_PAPER: &[&str] = &["desaturation", "colorization", "contours"];

/// `everything` of `pictures.rs`.
const EVERYTHING: &[&str] = &["desaturation", "colorization", "black_flats", "contours"];

/// `many_passes` of `failures/devices.rs`.
const MANY_PASSES: &[&str] = &[
    "desaturation",
    "colorization",
    "contours",
    "outlines",
    "hatching",
    "halftone",
    "paint",
    "paper",
];

/// What every test shows that draws an effect with one sample.
const DRAWN: &[Feature] = &[Vulkan, Msaa1, Texture];
/// What every test shows that draws it with one sample and with four.
const DRAWN_TWICE: &[Feature] = &[Vulkan, Msaa1, Msaa4, Texture];

/// What the rows of `pairwise` have.
pub const PAIRED: &[Feature] = &[
    Msaa1,
    Msaa4,
    Hdr,
    Taa,
    Fxaa,
    Smaa,
    Resolution,
    Deferred,
    Orthographic,
    Oblique,
    OffCentre,
    Viewport,
];

/// Features, effects (none: all), and how it is known.
type Fact = (&'static [Feature], &'static [&'static str], Known);

#[rustfmt::skip]
pub const FACTS: &[Fact] = &[
    (PAIRED, ALL, Pairs),
    (
        &[SplitScreen, SeveralCameras],
        ALL,
        Run("together::views_beside_others_are_drawn_as_alone"),
    ),
    (
        &[Transparent, Skinned, Instanced],
        ALL,
        Run("together::meshes_of_every_kind_are_drawn_as_plain_ones"),
    ),
    (&[Metal, Direct3D12, WebGpu], ALL, Translated),
    (&[OpenGl], ALL, Run("open_gl::every_effect_is_drawn_as_with_vulkan")),
    (&[WebGl2], ALL, Unknown),
    (&[NoCompute], ALL, Run("open_gl::every_effect_is_drawn_within_the_limits_of_webgl2")),
    (&[NoCompute], MANY_PASSES, Run("failures::devices::a_device_without_compute_shaders_draws_a_style")),

    (&[Msaa2, Msaa4, Msaa8, Hdr], ALL, Unknown),
    (DRAWN_TWICE, OF_PRESETS, Run("pictures::every_preset_matches_the_reference_with_and_without_msaa")),
    (DRAWN_TWICE, &["abstraction"], Run("abstraction::far_things_are_paler_and_have_fewer_tones")),
    (DRAWN_TWICE, &["focus"], Run("focus::every_pixel_matches_the_reference")),
    (DRAWN, &["paint"], Run("paint::every_pixel_matches_the_reference")),
    (&[Msaa4], &["paint"], Run("paint::a_transparent_background_stays")),
    (DRAWN, &["hatching"], Run("hatching::flat_fields_keep_their_mean_tone")),
    (DRAWN, &["iso_lines"], Run("iso_lines::heights_are_right_in_perspective")),
    (&[Msaa4], OF_LOOKS, Run("style_limits::looks_keep_their_limits")),
    (DRAWN, &["two_tone"], Run("two_tone::every_pixel_matches_the_reference")),
    (DRAWN, &["speed_lines"], Run("speed_lines::every_pixel_matches_the_reference")),

    (&[Hdr], EVERYTHING, Run("pictures::an_hdr_camera_matches_the_reference")),
    (&[Hdr], &["tone_bands", "outlines"], Run("extremes::bright_light_grows_with_its_gain")),
    (&[Hdr], &["paint"], Run("paint::extreme_values_are_finite")),
    (&[Hdr], &["focus"], Run("focus::extreme_values_are_finite")),
    (&[Hdr], &["misregistration"], Run("misregistration::light_and_settings_out_of_range_are_finite")),
    (&[Hdr], &["halftone"], Run("halftone::backgrounds_stay_transparent_and_light_stays_finite")),
    (&[Hdr], &["iso_lines"], Run("iso_lines::floors_to_the_horizon_are_finite_and_clear")),
    (&[Hdr], &["two_tone"], Run("two_tone::every_pixel_matches_the_reference")),
    (&[Hdr], &["speed_lines"], Run("speed_lines::every_pixel_matches_the_reference")),
    (&[Hdr], &["paper"], Run("paper::every_pixel_matches_the_reference")),
    (&[Hdr], &["vignette"], Run("hatched_material::extreme_strokes_are_finite")),

    (&[Taa, Fxaa, Smaa, Resolution, Deferred], ALL, Unknown),
    (&[Taa], &["outlines"], Run("jitter::lines_stay_at_their_edge_under_temporal_anti_aliasing")),
    (&[Taa], &["outlines"], Run("memory::object_edges_are_drawn_under_temporal_anti_aliasing")),
    (&[Fxaa, Smaa], FIRST_PAPER, Run("failures::views::styles_work_beside_the_engines_post_processes")),
    (&[Fxaa, Smaa], &["halftone", "outlines", "paper"], Run("halftone::dots_and_grain_are_drawn_after_anti_aliasing")),
    (&[Resolution], &["outlines"], Run("upscaled::outlines_are_where_the_geometry_is")),
    (&[Resolution], &["contours"], Run("upscaled::contours_are_where_the_geometry_is")),
    (&[Resolution], &["black_flats"], Run("upscaled::an_even_slope_is_as_steep_at_every_resolution")),
    (&[Resolution], &["halftone", "misregistration", "speed_lines", "paper"], Run("upscaled::the_page_has_the_size_of_the_picture")),
    (&[Deferred], FIRST_PAPER, Run("failures::views::a_deferred_camera_looks_like_a_forward_one")),

    (&[Orthographic, Oblique, OffCentre], ALL, Unknown),
    (&[Orthographic], &["outlines"], Run("outlines::an_orthographic_view_has_the_same_outlines_at_any_scale")),
    (&[Orthographic], &["contours"], Run("lines::an_orthographic_view_draws_the_same_lines")),
    (&[Orthographic], &["black_flats"], Run("upscaled::an_even_slope_is_as_steep_at_every_resolution")),
    (&[Orthographic], &["colorization"], Run("percentiles::a_speck_does_not_stretch_an_orthographic_range")),
    (&[Orthographic], &["paint"], Run("paint::an_edge_stays_sharp")),
    (&[Orthographic], &["focus"], Run("focus::an_orthographic_view_has_a_focus")),
    (&[Orthographic], &["misregistration"], Run("page_scale::plates_out_of_register_are_as_far_apart")),
    (&[Orthographic], &["halftone"], Run("object_screen::dots_lie_on_their_object")),
    (&[Orthographic], &["iso_lines"], Run("iso_lines::heights_are_where_they_are")),
    (&[Orthographic], &["two_tone"], Run("two_tone::lines_stay_smooth")),
    (&[Orthographic], &["speed_lines"], Run("speed_lines::every_pixel_matches_the_reference")),
    (&[Orthographic], &["paper"], Run("paper::the_mean_tone_stays")),
    (&[Oblique], &["colorization"], Run("smoothing_views::an_oblique_near_plane_that_moves_does_not_start_anew")),

    (&[Viewport, SplitScreen, SeveralCameras], ALL, Unknown),
    (&[Viewport], EVERYTHING, Run("pictures::a_viewport_is_styled_inside_and_untouched_outside")),
    (&[Viewport], &["outlines"], Run("line_samples::a_multisampled_viewport_matches_the_reference")),
    (&[Viewport], &["paint"], Run("paint::a_viewport_is_a_picture_of_its_own")),
    (&[Viewport], &["focus"], Run("focus::a_viewport_is_a_picture_of_its_own")),
    (&[Viewport], &["misregistration", "tone_bands"], Run("misregistration::every_pixel_matches_the_reference")),
    (&[Viewport], &["halftone"], Run("halftone::viewports_are_pages_or_parts_of_one")),
    (&[Viewport], &["speed_lines"], Run("speed_lines::a_viewport_is_a_picture_of_its_own")),
    (&[Viewport], &["paper"], Run("paper::a_view_can_have_its_own_sheet")),
    (&[SplitScreen], &["contours", "desaturation"], Run("failures::views::each_camera_on_a_shared_target_has_its_own_range")),
    (&[SplitScreen, SeveralCameras], &["paper"], Run("paper::a_split_screen_is_one_sheet")),
    (&[SeveralCameras], &["contours"], Run("failures::views::each_camera_on_a_shared_target_has_its_own_range")),
    (&[SeveralCameras], &["colorization"], Run("smoothing_views::cameras_have_ranges_of_their_own")),

    (&[Morphed, OwnPipeline], ALL, Unknown),
    (&[Transparent], &["outlines", "desaturation", "colorization", "contours", "sketch"],
        Run("transparent_lines::it_is_drawn_as_an_opaque_mesh_would_be")),
    (&[Skinned, Morphed], &["outlines"], Run("sections::pictures_with_sections_match_the_reference")),
    (&[Instanced], &["outlines"], Run("ids::touching_objects_of_like_depth_and_normal_have_an_edge")),
    (&[OwnPipeline], &["outlines"], NotSupported("no edges between objects")),
];
