//! Odd numbers in every field of a value, which are found by reflection.

use std::{
    fmt::Debug,
    time::{Duration, Instant},
};

use bevy::reflect::{
    PartialReflect, ReflectMut, ReflectRef,
    enums::{DynamicEnum, DynamicVariant, Enum, VariantInfo},
};

use crate::settings::FieldRange;

/// How many inputs are tried: the variable `FUZZ_CASES`, else 5000.
pub(crate) fn cases() -> usize {
    let given = std::env::var("FUZZ_CASES").ok();
    given.and_then(|text| text.parse().ok()).unwrap_or(5000)
}

/// What `f` makes of an input. Panics if that takes a second or longer.
pub(crate) fn in_time<T>(input: &impl Debug, f: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let made = f();
    let took = start.elapsed();
    assert!(took < Duration::from_secs(1), "{took:?}: {input:?}");
    made
}

/// Repeatable numbers: xorshift64*, Marsaglia and Vigna.
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn bits(&mut self) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32) as u32
    }

    /// A number below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.bits() as usize % end.max(1)
    }

    /// Half of them are from -1 to 3; the others have any bits, or are the ends of all ranges.
    fn float(&mut self) -> f32 {
        const ENDS: [f32; 10] = [
            0.0,
            -0.0,
            1e-45,
            f32::MIN_POSITIVE,
            f32::EPSILON,
            f32::MAX,
            f32::MIN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
        ];
        match self.below(8) {
            0 => ENDS[self.below(ENDS.len())],
            1..=3 => f32::from_bits(self.bits()),
            _ => (self.bits() >> 8) as f32 / (1 << 22) as f32 - 1.0,
        }
    }

    fn count(&mut self) -> u32 {
        match self.below(4) {
            0 => self.bits(),
            1 => u32::MAX,
            _ => self.below(20) as u32,
        }
    }
}

/// Gives all numbers, flags and modes of a value odd ones. Lists keep their length, and enums with
/// fields their variant.
pub(crate) fn scramble(value: &mut dyn PartialReflect, numbers: &mut Numbers) {
    if let Some(x) = value.try_downcast_mut::<f32>() {
        *x = numbers.float();
    } else if let Some(n) = value.try_downcast_mut::<u32>() {
        *n = numbers.count();
    } else if let Some(is_on) = value.try_downcast_mut::<bool>() {
        *is_on = numbers.below(2) == 0;
    } else {
        scramble_fields(value, numbers);
    }
}

fn scramble_fields(value: &mut dyn PartialReflect, numbers: &mut Numbers) {
    match value.reflect_mut() {
        ReflectMut::Struct(value) => {
            for k in 0..value.field_len() {
                if let Some(field) = value.field_at_mut(k) {
                    scramble(field, numbers);
                }
            }
        }
        ReflectMut::Enum(value) => {
            if let Some(mode) = mode(&*value, numbers) {
                value.apply(&mode);
            }
            for k in 0..value.field_len() {
                if let Some(field) = value.field_at_mut(k) {
                    scramble(field, numbers);
                }
            }
        }
        ReflectMut::List(value) => {
            for k in 0..value.len() {
                if let Some(item) = value.get_mut(k) {
                    scramble(item, numbers);
                }
            }
        }
        _ => {}
    }
}

/// Any mode of an enum whose variants have no fields.
fn mode(value: &dyn Enum, numbers: &mut Numbers) -> Option<DynamicEnum> {
    let info = value.get_represented_enum_info()?;
    let mut variants = info.iter();
    if !variants.all(|variant| matches!(variant, VariantInfo::Unit(_))) {
        return None;
    }
    let variant = info.variant_at(numbers.below(info.variant_len()))?;
    Some(DynamicEnum::new(variant.name(), DynamicVariant::Unit))
}

/// The first number that is not finite, or not in the range that its field documents, and where it
/// is. `range`: of the field that has the value.
pub(crate) fn wrong(value: &dyn PartialReflect, range: Option<FieldRange>) -> Option<String> {
    if let Some(x) = value.try_downcast_ref::<f32>() {
        return is_wrong(f64::from(*x), range).then(|| x.to_string());
    }
    if let Some(n) = value.try_downcast_ref::<u32>() {
        return is_wrong(f64::from(*n), range).then(|| n.to_string());
    }
    match value.reflect_ref() {
        ReflectRef::Struct(value) => {
            let info = value.get_represented_struct_info();
            (0..value.field_len()).find_map(|k| {
                let own = info.and_then(|info| FieldRange::of(info.field_at(k)?));
                // Components of a vector have the range of the vector.
                let found = wrong(value.field_at(k)?, own.or(range))?;
                Some(format!("{}: {found}", value.name_at(k).unwrap_or_default()))
            })
        }
        ReflectRef::Enum(value) => (0..value.field_len()).find_map(|k| {
            let found = wrong(value.field_at(k)?, range_of(value, k).or(range))?;
            Some(format!("{}: {found}", value.variant_name()))
        }),
        // The range of a list is that of its length.
        ReflectRef::List(value) => (0..value.len()).find_map(|k| wrong(value.get(k)?, None)),
        _ => None,
    }
}

/// The range of a field of the variant that an enum has.
fn range_of(value: &dyn Enum, k: usize) -> Option<FieldRange> {
    let info = value.get_represented_enum_info()?;
    match info.variant(value.variant_name())? {
        VariantInfo::Struct(variant) => FieldRange::of(variant.field_at(k)?),
        VariantInfo::Tuple(variant) => variant.field_at(k)?.get_attribute().copied(),
        VariantInfo::Unit(_) => None,
    }
}

fn is_wrong(x: f64, range: Option<FieldRange>) -> bool {
    // Ends have the precision of 32 bits.
    let slack = |end: f64| 1e-6 * end.abs();
    let is_outside = |r: FieldRange| x < r.min - slack(r.min) || x > r.max + slack(r.max);
    !x.is_finite() || range.is_some_and(is_outside)
}
