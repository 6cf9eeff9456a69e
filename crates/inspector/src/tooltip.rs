//! Tooltips, made from the documentation comments of settings.
//!
//! A tooltip says what a setting does, then its range and default, then its
//! source. Documentation comments are Markdown for rustdoc; the markup and what
//! only programmers need is removed.

use super::fields::label_of_mode;

/// Words before whose full stop a sentence does not end.
const ABBREVIATIONS: &[&str] = &["Eq", "Eqs", "Fig", "Figs", "e.g", "i.e", "cf", "vs", "Sec"];

/// The papers that documentation comments cite by a key, and their authors.
const PAPERS: &[(&str, &str)] = &[("[CS]", "Suarez et al."), ("[CL]", "Wang")];

/// The tooltip of a documentation comment.
pub fn tooltip(docs: &str) -> String {
    let mut does = Vec::new();
    let mut range = Vec::new();
    let mut sources = Vec::new();
    for paragraph in paragraphs(docs) {
        let (text, cited) = without_parenthesised_citations(&paragraph);
        sources.extend(cited);
        let mut said = Vec::new();
        for sentence in sentences(&text) {
            if is_citation(&sentence) {
                sources.push(sentence.trim_end_matches('.').to_owned());
            } else if let Some((cited, rest)) = leading_citation(&sentence) {
                sources.push(cited);
                said.push(capitalized(&rest));
            } else if sentence.starts_with("Range ") || sentence.starts_with("Default") {
                range.push(sentence);
            } else if !sentence.is_empty() {
                said.push(sentence);
            }
        }
        if !said.is_empty() {
            does.push(said.join(" "));
        }
    }
    let mut lines = does;
    if !range.is_empty() {
        lines.push(range.join(" "));
    }
    sources.dedup();
    if !sources.is_empty() {
        lines.push(format!("Source: {}.", sources.join("; ")));
    }
    with_names_of_papers(&lines.join("\n"))
}

/// The documentation as one line of plain text.
pub fn plain(docs: &str) -> String {
    with_names_of_papers(&paragraphs(docs).join(" "))
}

/// The paragraphs of a documentation comment without markup.
fn paragraphs(docs: &str) -> Vec<String> {
    let mut paragraphs = vec![String::new()];
    for line in docs.lines().map(str::trim) {
        if is_link_definition(line) {
            continue;
        }
        if line.is_empty() {
            paragraphs.push(String::new());
        } else if let Some(paragraph) = paragraphs.last_mut() {
            if !paragraph.is_empty() {
                paragraph.push(' ');
            }
            paragraph.push_str(line);
        }
    }
    paragraphs
        .iter()
        .map(|paragraph| without_markup(paragraph, true))
        .filter(|paragraph| !paragraph.is_empty())
        .collect()
}

/// Whether a line defines the target of a link: ``[`X`]: bevy_comics::X``.
fn is_link_definition(line: &str) -> bool {
    line.starts_with('[')
        && line
            .split_once("]: ")
            .is_some_and(|(_, target)| !target.trim().contains(' '))
}

/// Text without the markup of links, code and escapes. Citations keep their
/// brackets: `\[CS\]` becomes `[CS]`. `starts_sentence` if the text is the start of
/// one.
fn without_markup(text: &str, starts_sentence: bool) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        let starts_sentence = (plain.is_empty() && starts_sentence) || plain.ends_with(". ");
        match c {
            '\\' => {
                if let Some(escaped) = rest.chars().next() {
                    plain.push(escaped);
                    rest = &rest[escaped.len_utf8()..];
                }
            }
            '[' => match link(rest) {
                Some((text, after)) => {
                    plain.push_str(&without_markup(text, starts_sentence));
                    rest = after;
                }
                None => plain.push('['),
            },
            '`' => {
                let (code, after) = rest.split_once('`').unwrap_or((rest, ""));
                plain.push_str(&name_in_panel(code, starts_sentence));
                rest = after;
            }
            '*' if rest.starts_with('*') => rest = &rest[1..],
            _ => plain.push(c),
        }
    }
    plain.trim().to_owned()
}

/// The text of a link and what follows it, after its opening bracket. The key
/// of a citation is no link.
fn link(rest: &str) -> Option<(&str, &str)> {
    let (text, after) = rest.split_once(']')?;
    if PAPERS.iter().any(|(key, _)| key[1..key.len() - 1] == *text) {
        return None;
    }
    let after = match after.strip_prefix('(').and_then(|a| a.split_once(')')) {
        Some((_, after)) => after,
        None => match after.strip_prefix('[').and_then(|a| a.split_once(']')) {
            Some((_, after)) => after,
            None => after,
        },
    };
    Some((text, after))
}

/// What the panel calls something that the documentation names in Rust: a value
/// of an enum by its label, `None` and booleans by the state of a check box.
fn name_in_panel(code: &str, starts_sentence: bool) -> String {
    let word = match code {
        "None" | "false" => "off",
        "true" => "on",
        _ => match code.rsplit_once("::") {
            Some((_, "default" | "DEFAULT" | "default()")) => "its default settings",
            Some((_, name)) if name.starts_with(char::is_uppercase) => {
                return label_of_mode(name);
            }
            Some((owner, name)) => return field_in_panel(owner, name),
            // The label of a field, but not a variable such as `k_p`.
            None if code.split('_').all(|part| part.len() > 1) => &code.replace('_', " "),
            None => code,
        },
    };
    if starts_sentence {
        capitalized(word)
    } else {
        word.to_owned()
    }
}

/// A field by its label, with its owner unless that is the documented type.
fn field_in_panel(owner: &str, name: &str) -> String {
    let name = name.replace('_', " ");
    match owner.rsplit("::").next().unwrap_or(owner) {
        "Self" => name,
        owner => format!("{name} of {}", label_of_mode(owner).to_lowercase()),
    }
}

/// The sentences of a text.
fn sentences(text: &str) -> Vec<String> {
    let mut sentences = Vec::new();
    let mut start = 0;
    for (end, _) in text.match_indices(". ") {
        let word = text[start..end].rsplit([' ', '(']).next().unwrap_or("");
        let next = text[end + 2..].chars().next();
        // A sentence may begin with a citation: `[CS]`.
        if !ABBREVIATIONS.contains(&word) && next.is_some_and(|c| c.is_uppercase() || c == '[') {
            sentences.push(text[start..=end].trim().to_owned());
            start = end + 2;
        }
    }
    sentences.push(text[start..].trim().to_owned());
    sentences.retain(|sentence| !sentence.is_empty());
    sentences
}

/// The words with which a citation begins.
const CITATION_WORDS: &[&str] = &[
    "[CS]", "[CL]", "Eq.", "Eqs.", "Fig.", "Figs.", "Figure", "Figures", "Section",
];

/// Whether a text is nothing but a citation: a paper with its equations, figures
/// and sections, and their numbers.
fn is_citation(text: &str) -> bool {
    let is_number = |word: &str| {
        word.chars()
            .all(|c| c.is_ascii_digit() || ".,-–".contains(c))
    };
    let begins = |word: &str| CITATION_WORDS.contains(&word.trim_end_matches(','));
    text.split_whitespace().next().is_some_and(begins)
        && text
            .split_whitespace()
            .all(|word| begins(word) || is_number(word) || ["and", "to"].contains(&word))
}

/// The text without citations in parentheses, and those citations.
fn without_parenthesised_citations(text: &str) -> (String, Vec<String>) {
    let mut plain = String::new();
    let mut cited = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('(') {
        plain.push_str(before);
        match after.split_once(')') {
            Some((inner, behind)) if is_citation(inner) => {
                cited.push(inner.to_owned());
                plain.truncate(plain.trim_end().len());
                rest = behind;
            }
            _ => {
                plain.push('(');
                rest = after;
            }
        }
    }
    plain.push_str(rest);
    (plain.trim().to_owned(), cited)
}

/// The citation before the colon or comma with which a sentence begins, and the
/// rest: `\[CS\] Eq. 4: the nearest distance becomes 0.`
fn leading_citation(sentence: &str) -> Option<(String, String)> {
    let (cited, rest) = sentence
        .split_once(": ")
        .or_else(|| sentence.split_once(", "))?;
    is_citation(cited).then(|| (cited.to_owned(), rest.to_owned()))
}

fn with_names_of_papers(text: &str) -> String {
    PAPERS
        .iter()
        .fold(text.to_owned(), |text, (key, name)| text.replace(key, name))
}

fn capitalized(text: &str) -> String {
    let mut chars = text.chars();
    match chars.next() {
        Some(first) => first.to_uppercase().chain(chars).collect(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_removed() {
        for (docs, plain_text) in [
            (" A [`Link`]\n to \\[CS\\]. ", "A Link to Suarez et al.."),
            (
                "See [the guide](https://example.org/a_b).",
                "See the guide.",
            ),
            ("With [`Self::BarrierFree`].", "With Barrier free."),
            (
                "[`BarrierFree`](Self::BarrierFree) runs.",
                "BarrierFree runs.",
            ),
            (
                "`None` draws none. Default: `false`.",
                "Off draws none. Default: off.",
            ),
            ("Is **bold** and `code`.", "Is bold and code."),
            ("Text.\n\n[`X`]: bevy_comics::X", "Text."),
            (
                "`edge_limit` of `k_p`, as [`Creases::edge_limit`] and [`Self::low_end`].",
                "Edge limit of k_p, as edge limit of creases and low end.",
            ),
            (
                "Default: [`Creases::default`].",
                "Default: its default settings.",
            ),
        ] {
            assert_eq!(plain(docs), plain_text);
        }
    }

    #[test]
    fn a_tooltip_says_what_a_setting_does_then_its_range_then_its_source() {
        assert_eq!(
            tooltip(
                " Mixes a color in (\\[CS\\] Eq. 6 and 7). Range 0 to 1, default 0.5.\n\
                 More of it (at the far end) hides detail.\n"
            ),
            "Mixes a color in. More of it (at the far end) hides detail.\n\
             Range 0 to 1, default 0.5.\n\
             Source: Suarez et al. Eq. 6 and 7."
        );
        assert_eq!(
            tooltip("\\[CL\\] Eq. 2: linear between the planes. A counter-example, e.g. outdoors."),
            "Linear between the planes. A counter-example, e.g. outdoors.\nSource: Wang Eq. 2."
        );
        assert_eq!(tooltip("Width of a line."), "Width of a line.");
        assert_eq!(tooltip("Ends (1 to 2) and ()."), "Ends (1 to 2) and ().");
        assert_eq!(
            tooltip("Logarithmic. \\[CS\\] Eq. 3. Eq. 4 is linear."),
            "Logarithmic. Eq. 4 is linear.\nSource: Suarez et al. Eq. 3."
        );
        assert_eq!(
            tooltip("First.\n\nSecond, as in Eq. 4. Third."),
            "First.\nSecond, as in Eq. 4. Third."
        );
    }
}
