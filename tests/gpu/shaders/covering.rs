//! Rows of choices that together have every pair of choices that can be.

use super::{Definitions, Variant};
use crate::prelude::*;

/// One way of something, with its definitions. One that ends in `=` and a number has that value.
pub type Choice = &'static [&'static str];

/// Two factors with a level each.
pub type Pair = [(usize, usize); 2];

/// The definitions of rows, and the pairs that no row has.
pub struct Covering {
    pub rows: Vec<Vec<&'static str>>,
    pub never: Vec<[Choice; 2]>,
}

pub fn definition(text: &'static str) -> Definition<'static> {
    match text.split_once('=') {
        Some((name, number)) => (name, Some(number.parse().expect("a number"))),
        None => (text, None),
    }
}

pub fn definitions(texts: &[&'static str]) -> Definitions {
    texts.iter().copied().map(definition).collect()
}

/// Lists of choices, each from a text in which `|` divides choices of several words or none.
pub fn parsed(lists: &[&'static str]) -> Vec<&'static [Choice]> {
    let words =
        |choice: &'static str| -> Choice { choice.split_whitespace().collect::<Vec<_>>().leak() };
    let list = |text: &&'static str| -> &'static [Choice] {
        text.split('|').map(words).collect::<Vec<_>>().leak()
    };
    lists.iter().map(list).collect()
}

/// The rows of lists, each written as [`parsed`] reads it, that have every pair.
pub fn rows(
    lists: &[&'static str],
    resolved: fn(Vec<&'static str>) -> Vec<&'static str>,
) -> Vec<Definitions> {
    let found = covering(&parsed(lists), resolved).rows;
    found.iter().map(|row| definitions(row)).collect()
}

/// A file with each of these texts as its definitions.
pub fn each(file: &'static str, texts: &[&'static str]) -> Vec<Variant> {
    let words = |text: &&'static str| text.split_whitespace().collect::<Vec<_>>();
    texts
        .iter()
        .map(|text| (file, definitions(&words(text))))
        .collect()
}

/// Rows with every pair, for one file.
pub fn pairs(
    file: &'static str,
    lists: &[&'static str],
    resolved: fn(Vec<&'static str>) -> Vec<&'static str>,
) -> Vec<Variant> {
    rows(lists, resolved)
        .into_iter()
        .map(|row| (file, row))
        .collect()
}

/// Whether one of these texts is `name`.
pub fn has(texts: &[&'static str], name: &str) -> bool {
    texts.contains(&name)
}

/// Whether one of these texts is among `names`.
pub fn has_any(texts: &[&'static str], names: &[&str]) -> bool {
    names.iter().any(|name| has(texts, name))
}

/// Adds a definition under a condition.
pub fn push_if(is_set: bool, names: &mut Vec<&'static str>, name: &'static str) {
    if is_set {
        names.push(name);
    }
}

/// Adds a definition where there is any of others.
pub fn also(names: &mut Vec<&'static str>, others: &[&str], name: &'static str) {
    push_if(has_any(names, others), names, name);
}

/// Those of these variants that set something, or a number, that none before them sets.
pub fn fewest<V: AsRef<[Definition<'static>]>>(variants: Vec<V>) -> Vec<V> {
    let mut seen = BTreeSet::new();
    let mut kept = variants;
    kept.retain(|variant| {
        let before = seen.len();
        seen.extend(variant.as_ref().iter().copied());
        seen.len() > before
    });
    kept
}

/// Every pair of levels of two factors.
pub fn all_pairs(sizes: &[usize]) -> BTreeSet<Pair> {
    let mut all = BTreeSet::new();
    for (j, second) in sizes.iter().enumerate() {
        for (i, first) in sizes[..j].iter().enumerate() {
            for a in 0..*first {
                all.extend((0..*second).map(|b| [(i, a), (j, b)]));
            }
        }
    }
    all
}

/// Rows of a level of every factor that together have every pair of levels that can be, and the
/// pairs that cannot. Each row is the best of several random ones. `counts`: which factors of a row
/// have their level.
pub fn cover(
    sizes: &[usize],
    counts: impl Fn(&[usize]) -> Vec<bool>,
) -> (Vec<Vec<usize>>, Vec<Pair>) {
    assert!(sizes.len() > 1, "one factor has no pairs");
    let mut missing = all_pairs(sizes);
    let mut random = Random::new(1);
    let (mut rows, mut never) = (Vec::new(), Vec::new());
    while let Some(wanted) = missing.first().copied() {
        // A pair may need a third level: one of many random rows has it.
        let candidates = (0..120).map(|_| {
            let level = |size: &usize| (random.unit() * *size as f32) as usize;
            let mut row: Vec<usize> = sizes.iter().map(level).collect();
            for (factor, level) in wanted {
                row[factor] = level;
            }
            let counts = counts(&row);
            let has = |(factor, level): (usize, usize)| counts[factor] && row[factor] == level;
            let new = |pair: &&Pair| pair.iter().all(|one| has(*one));
            let new: Vec<Pair> = missing.iter().filter(new).copied().collect();
            (row, new)
        });
        let candidates = candidates.filter(|(_, new)| new.contains(&wanted));
        let Some((row, new)) = candidates.max_by_key(|(_, new)| new.len()) else {
            missing.remove(&wanted);
            never.push(wanted);
            continue;
        };
        for pair in new {
            missing.remove(&pair);
        }
        rows.push(row);
    }
    (rows, never)
}

/// The same of lists of choices. `resolved`: the definitions of a row without those that need
/// others it lacks, and with what follows from them.
pub fn covering(
    lists: &[&[Choice]],
    resolved: impl Fn(Vec<&'static str>) -> Vec<&'static str>,
) -> Covering {
    let sizes: Vec<usize> = lists.iter().map(|list| list.len()).collect();
    let names = |row: &[usize]| {
        let chosen = lists.iter().zip(row).flat_map(|(list, k)| list[*k]);
        resolved(chosen.copied().collect())
    };
    let (rows, never) = cover(&sizes, |row| {
        let names = names(row);
        let chosen = lists.iter().zip(row).map(|(list, k)| list[*k]);
        chosen
            .map(|choice| choice.iter().all(|name| names.contains(name)))
            .collect()
    });
    Covering {
        rows: rows.iter().map(|row| names(row)).collect(),
        never: never
            .iter()
            .map(|pair| pair.map(|(i, k)| lists[i][k]))
            .collect(),
    }
}
