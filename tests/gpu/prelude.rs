//! What most tests use.

pub use std::{
    collections::{BTreeMap, BTreeSet, HashMap, HashSet},
    ops::Range,
    path::{Path, PathBuf},
    process::Command,
    sync::{Mutex, OnceLock},
    time::Duration,
};

pub use bevy::{
    anti_alias::{fxaa::Fxaa, smaa::Smaa, taa::TemporalAntiAliasing},
    asset::RenderAssetUsages,
    camera::{
        Exposure, Hdr, OrthographicProjection, PerspectiveProjection, RenderTarget, ScalingMode,
        Viewport,
    },
    color::Color,
    core_pipeline::{
        prepass::{DeferredPrepass, DepthPrepass, MotionVectorPrepass, NormalPrepass},
        tonemapping::{DebandDither, Tonemapping},
    },
    image::Image,
    math::{DMat4, DQuat, DVec2, DVec3, Mat4, UVec2, Vec2, Vec3},
    mesh::{
        Indices, VertexAttributeValues,
        morph::{MeshMorphWeights, MorphWeights},
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
    reflect::TypeInfo,
    render::{
        RenderApp,
        error_handler::RenderErrorHandler,
        render_resource::{Extent3d, TextureDimension, TextureFormat},
        renderer::RenderDevice,
        sync_world::RenderEntity,
        view::Msaa,
    },
};

pub use bevy_comics::{
    Abstraction, BlackFlats, CameraCut, ColorHarmony, Colorization, Comic, ComicStyle,
    ComicsDiagnostics, ComicsPlugin, Contours, DepthLayers, DepthMap, DepthMapping, Desaturation,
    Effect, EffectPlugin, Focus, Halftone, Hatching, IsoLines, KeyLight, Misregistration,
    NoOutlines, NoStyle, OutlineGroup, OutlineStyle, Outlines, Paint, Paper, Sketch, SpeedLines,
    SplitView, StyleWeight, ToneBands, ToneRamp, ToneRange, ToonLight, ToonMaterial, ToonScene,
    TwoTone, Vignette,
    depth::{DepthHistogram, RangeSmoothing, ReductionMethod, VisibleDepthRange},
    diagnostics::{ComicsStage, DebugView, SkipReason, StageOutcome},
    effect::{AnyEffect, EffectContext, EffectRegistry, EffectShader, EffectStage, Needs},
    effects::{
        ColorizationMode, ContourOperator, DepthLayer, Equations, FocusAt, FocusStyle, Granularity,
        HalftoneMode, HarmonyMode, HatchingAnchor, HatchingGround, HatchingKind, LayerBorders,
        PaintKernel, ScreenAnchor, ScreenSampling, ScreenShape, SpeedLineKind,
    },
    lines::{Creases, LineBoil, LineColor, LineResponse, LineWeight, ObjectEdges, Silhouettes},
    objects::{DepthWrite, MeshSections, PatternAnchor},
    presets,
    toon::{
        DetailAxis, HighlightFrame, HighlightShape, ProxyShape, Ramp, RampBlend, RampDetail,
        RampMap, RampMode, RampStop, Rim, RimWidth, ShadingProxy, StylizedHighlight, ToonShading,
    },
};

pub use bevy_comics_testkit::{
    headless::{Headless, HeadlessOptions, new_target},
    read_back::{FloatImage, IdImage},
    scenes::{BuiltIn, noise::Random},
    screens::SHAPES,
    specimens::Specimen,
    studio::{Studio, with_map},
    truth::FINE,
    wgsl::Definition,
};

pub use crate::small::{
    Object, Small, apart, black_ink, changed, differ, linear, options, size, unlit, with_option,
};
