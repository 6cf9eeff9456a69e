//! Reference of `depth/range.wgsl`: a plain scan.

use super::raw;

/// Bits of the nearest and the farthest depth; `None` without geometry.
pub fn scan(depths: impl IntoIterator<Item = f32>) -> Option<[u32; 2]> {
    depths
        .into_iter()
        .map(raw::key)
        .filter(|key| *key != 0)
        .map(|key| [key, key])
        .reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
}
