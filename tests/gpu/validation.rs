//! Vulkan's validation layer. `scripts/validate` runs all tests under it: every app checks after each
//! frame that it has said nothing.

use bevy_comics_testkit::{device::gpu, validation};

/// A layer that is missing is silent, too.
#[test]
fn the_layer_is_active_where_it_is_wanted() {
    gpu();
    if !validation::is_wanted() {
        return;
    }
    assert_ne!(
        validation::is_loaded(),
        Some(false),
        "the layer is not loaded"
    );
}
