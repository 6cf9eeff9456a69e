//! Rows of choices that together have every pair of choices that can be.

use super::Definitions;
use crate::prelude::*;

/// One way of something, with its definitions. One that ends in `=` and a number has that value.
pub type Choice = &'static [&'static str];

/// Two lists, each followed by the number of a choice.
type Pair = (usize, usize, usize, usize);

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

/// A list of choices from a line, in which `|` divides choices of several words or none.
fn list(line: &'static str) -> &'static [Choice] {
    let words =
        |choice: &'static str| -> Choice { choice.split_whitespace().collect::<Vec<_>>().leak() };
    line.split('|').map(words).collect::<Vec<_>>().leak()
}

/// The rows of lists, each written as [`list`] reads it, that have every pair.
pub fn rows(
    lists: &[&'static str],
    resolved: fn(Vec<&'static str>) -> Vec<&'static str>,
) -> Vec<Definitions> {
    let lists: Vec<&[Choice]> = lists.iter().map(|line| list(line)).collect();
    let found = covering(&lists, resolved).rows;
    found.iter().map(|row| definitions(row)).collect()
}

/// Whether one of these texts is `name`.
pub fn has(texts: &[&'static str], name: &str) -> bool {
    texts.contains(&name)
}

/// Whether one of these texts is among `names`.
pub fn has_any(texts: &[&'static str], names: &[&str]) -> bool {
    names.iter().any(|name| has(texts, name))
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

fn all_pairs(lists: &[&[Choice]]) -> BTreeSet<Pair> {
    let mut all = BTreeSet::new();
    for (i, first) in lists.iter().enumerate() {
        for (j, second) in lists.iter().enumerate().skip(i + 1) {
            for a in 0..first.len() {
                all.extend((0..second.len()).map(|b| (i, a, j, b)));
            }
        }
    }
    all
}

/// The pairs of choices that a row has and that are compiled.
fn pairs(lists: &[&[Choice]], row: &[usize], names: &[&'static str]) -> Vec<Pair> {
    let is_compiled =
        |(i, a): &(usize, usize)| lists[*i][*a].iter().all(|name| names.contains(name));
    let kept: Vec<(usize, usize)> = row
        .iter()
        .copied()
        .enumerate()
        .filter(is_compiled)
        .collect();
    let mut found = Vec::new();
    for (k, (i, a)) in kept.iter().enumerate() {
        found.extend(kept[k + 1..].iter().map(|(j, b)| (*i, *a, *j, *b)));
    }
    found
}

/// Rows of one choice of every list that together have every pair of choices that can be. Each row is the
/// best of several random ones. `resolved`: the definitions of a row without those that need others it
/// lacks, and with what follows from them.
pub fn covering(
    lists: &[&[Choice]],
    resolved: impl Fn(Vec<&'static str>) -> Vec<&'static str>,
) -> Covering {
    let mut missing = all_pairs(lists);
    let mut state = 1u64;
    let mut random = move |below: usize| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as usize % below
    };
    let (mut rows, mut never) = (Vec::new(), Vec::new());
    while let Some(wanted) = missing.first().copied() {
        let (i, a, j, b) = wanted;
        // A pair may need a third choice: one of many random rows has it.
        let candidates = (0..120).map(|_| {
            let mut row: Vec<usize> = lists.iter().map(|list| random(list.len())).collect();
            (row[i], row[j]) = (a, b);
            let chosen = lists.iter().zip(&row).flat_map(|(list, k)| list[*k]);
            let names = resolved(chosen.copied().collect());
            let pairs = pairs(lists, &row, &names);
            (names, pairs)
        });
        let candidates = candidates.filter(|(_, pairs)| pairs.contains(&wanted));
        let new = |(_, pairs): &(Vec<&'static str>, Vec<Pair>)| {
            pairs.iter().filter(|pair| missing.contains(pair)).count()
        };
        let Some((names, pairs)) = candidates.max_by_key(new) else {
            missing.remove(&wanted);
            never.push([lists[i][a], lists[j][b]]);
            continue;
        };
        for pair in &pairs {
            missing.remove(pair);
        }
        rows.push(names);
    }
    Covering { rows, never }
}
