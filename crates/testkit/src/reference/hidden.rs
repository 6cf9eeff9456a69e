//! Reference of `lines/find/hidden.wgsl`: which pixels of marked objects are hidden.

/// By how much the picture is in front of a marked object, beyond a tenth of the jump that separates
/// two surfaces there. Above 0, the object is hidden. `picture`, `own`: raw depths; `jump`: as a
/// fraction of the reference, which is a factor of the raw depth and a constant.
pub fn in_front(picture: f64, own: f64, jump: f64, [factor, constant]: [f64; 2]) -> f64 {
    let separates = jump * (factor * own + constant);
    picture - (own + 0.1 * separates)
}

/// The bit of an object's marks where it is hidden. Below it are its slot and its section.
pub const HIDDEN: u32 = 1 << 16;
