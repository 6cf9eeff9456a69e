//! Reads GPU buffers on the CPU, which never waits for them.

use bevy::render::render_resource::{Buffer, MapMode};

/// Maps a buffer whose contents were submitted. `read` gets its words some frames later; `None` if
/// mapping fails, as on a lost device, whose buffers are dropped.
pub(crate) fn map_words(buffer: &Buffer, read: impl FnOnce(Option<Vec<u32>>) + Send + 'static) {
    let mapped = buffer.clone();
    buffer.slice(..).map_async(MapMode::Read, move |result| {
        read(result.is_ok().then(|| words(&mapped)));
    });
}

/// The words of a mapped buffer, which is unmapped.
fn words(buffer: &Buffer) -> Vec<u32> {
    let words = buffer
        .slice(..)
        .get_mapped_range()
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    buffer.unmap();
    words
}
