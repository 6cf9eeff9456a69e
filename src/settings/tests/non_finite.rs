//! Odd numbers in every field of a value, which are found by reflection.

use std::{
    fmt::Debug,
    time::{Duration, Instant},
};

use bevy::reflect::{
    PartialReflect, ReflectMut, ReflectRef, TypeInfo,
    attributes::CustomAttributes,
    enums::DynamicEnum,
    list::{List, ListInfo},
    structs::DynamicStruct,
};

use super::places::{is_color, made_variant};
use crate::settings::{
    FieldRange,
    parts::{attributes, part, part_mut},
};

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
    pub(super) fn float(&mut self) -> f32 {
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

/// Gives all numbers, flags and modes of a value odd ones, options any or none, and lists of structs
/// any length. Colors keep their space.
pub(crate) fn scramble(value: &mut dyn PartialReflect, numbers: &mut Numbers) {
    if let Some(x) = value.try_downcast_mut::<f32>() {
        *x = numbers.float();
    } else if let Some(n) = value.try_downcast_mut::<u32>() {
        *n = numbers.count();
    } else if let Some(is_on) = value.try_downcast_mut::<bool>() {
        *is_on = numbers.below(2) == 0;
    } else if let ReflectMut::List(items) = value.reflect_mut() {
        scramble_items(items, numbers);
    } else {
        if let Some(variant) = any_variant(value, numbers) {
            value.apply(&variant);
        }
        for i in 0.. {
            let Some(field) = part_mut(value, i) else {
                return;
            };
            scramble(field, numbers);
        }
    }
}

fn scramble_items(items: &mut dyn List, numbers: &mut Numbers) {
    let info = items.get_represented_list_info();
    if let Some(TypeInfo::Struct(_)) = info.and_then(ListInfo::item_info) {
        while items.pop().is_some() {}
        for _ in 0..numbers.below(20) {
            items.push(Box::new(DynamicStruct::default()));
        }
    }
    for i in 0..items.len() {
        if let Some(item) = items.get_mut(i) {
            scramble(item, numbers);
        }
    }
}

fn any_variant(value: &dyn PartialReflect, numbers: &mut Numbers) -> Option<DynamicEnum> {
    let info = value.get_represented_type_info()?.as_enum().ok()?;
    if is_color(value) {
        return None;
    }
    let variant = info.variant_at(numbers.below(info.variant_len()))?;
    made_variant(variant, None)
}

/// The first number that is not finite, or not in the range that its field documents, and where it
/// is. `outer`: attributes of the field that has the value.
pub(crate) fn wrong(
    value: &dyn PartialReflect,
    outer: Option<&CustomAttributes>,
) -> Option<String> {
    let number = value.try_downcast_ref::<f32>().map(|x| f64::from(*x));
    let count = || value.try_downcast_ref::<u32>().map(|n| f64::from(*n));
    if let Some(x) = number.or_else(count) {
        let range = outer.and_then(|attributes| attributes.get());
        return is_wrong(x, range).then(|| x.to_string());
    }
    if let ReflectRef::List(items) = value.reflect_ref() {
        // The range of a list is that of its length.
        return (0..items.len()).find_map(|i| wrong(items.get(i)?, None));
    }
    let mut fields = (0..).map_while(|i| Some((i, part(value, i)?)));
    fields.find_map(|(i, field)| {
        // Components of a vector have the range of the vector.
        let own = attributes(value, i, outer).filter(|own| !own.is_empty());
        let found = wrong(field, own.or(outer))?;
        Some(format!("{i}: {found}"))
    })
}

fn is_wrong(x: f64, range: Option<&FieldRange>) -> bool {
    // Ends have the precision of 32 bits.
    let slack = |end: f64| 1e-6 * end.abs();
    let is_outside = |r: &FieldRange| x < r.min - slack(r.min) || x > r.max + slack(r.max);
    !x.is_finite() || range.is_some_and(is_outside)
}
