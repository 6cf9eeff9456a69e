//! The sections of the report: what each measures, and the question that it answers.

use crate::{
    Run, flicker, growth, ink, ladder, lines, machine, many_objects, models, page, parts, peers,
    ranges, soak, stability, straight, toon,
};

/// A part of the report that is measured by itself.
pub struct Section {
    /// As `--only` names it.
    pub name: &'static str,
    pub measure: fn(&Run) -> Result<(), String>,
    /// For the index; empty if the section has no row there.
    pub question: &'static str,
    /// The heading of the text that has the answer.
    pub heading: &'static str,
    /// Whether it runs only where `--only` names it: it is long, and gives no accuracy and no
    /// times.
    pub is_alone: bool,
}

const fn section(
    name: &'static str,
    measure: fn(&Run) -> Result<(), String>,
    question: &'static str,
    heading: &'static str,
) -> Section {
    Section {
        name,
        measure,
        question,
        heading,
        is_alone: false,
    }
}

/// The heading of two sections.
const WHOLE: &str = "Whole and steady lines";

/// All sections, in the order in which they are measured.
pub const SECTIONS: [Section; 19] = [
    MACHINE,
    section(
        "ranges",
        ranges::measure,
        "What does finding the visible range take?",
        "The range",
    ),
    section(
        "lines",
        lines::measure,
        "Are outlines where the edges of a scene are?",
        "Lines",
    ),
    section(
        "models",
        models::measure,
        "Do outlines of turning models fall into fragments?",
        "Lines of models",
    ),
    section(
        "dashes",
        ink::dashes,
        "Do outlines of turning models break into dashes?",
        WHOLE,
    ),
    section(
        "history",
        ink::history,
        "Do lines hold still under temporal anti-aliasing?",
        WHOLE,
    ),
    section(
        "straight",
        straight::measure,
        "Are straight lines even, and as wide as asked?",
        "Straight lines",
    ),
    section(
        "page",
        page::measure,
        "Do prints, strokes and paint keep tones, colors and edges?",
        "The printed page",
    ),
    section(
        "stability",
        stability::measure,
        "Do extreme depths and colors break the picture?",
        "2. Stability on stiff and extreme cases",
    ),
    section(
        "ladder",
        ladder::measure,
        "What does each style cost, and an idle plugin? What is left out?",
        "3. What is left out",
    ),
    section(
        "parts",
        parts::measure,
        "What does each effect of the page cost, and each option of lines?",
        "Effects of the page",
    ),
    section(
        "scene-parts",
        parts::of_scenes,
        "What do sections, samples, fog and glass add to the cost of a style?",
        "Single parts",
    ),
    section(
        "toon",
        toon::measure,
        "What does the toon material cost?",
        "Toon material",
    ),
    section(
        "growth",
        growth::measure,
        "How does the cost grow with pixels, vertices (to a million) and cameras?",
        "4. Cost and its growth",
    ),
    section(
        "many-objects",
        many_objects::measure,
        "How does a frame grow with the number of objects?",
        "Many objects",
    ),
    section(
        "peers",
        peers::measure,
        "What do other crates cost?",
        "5. Other crates, in the same app and run",
    ),
    section(
        "peer-objects",
        peers::many_objects,
        "How do frames of other crates grow with the number of objects?",
        "Many objects",
    ),
    section(
        "flicker",
        flicker::measure,
        "Do colors by distance flicker when things come and go?",
        "6. A range that does not flicker",
    ),
    Section {
        is_alone: true,
        ..section(
            "soak",
            soak::measure,
            "In a long run, does memory grow or rendering fail?",
            "7. A long run",
        )
    },
];

/// What everything was measured on.
pub const MACHINE: Section = section("machine", machine, "", "");
