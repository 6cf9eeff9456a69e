//! The command line: everything is checked before anything is measured.

use std::{num::NonZero, path::PathBuf};

use crate::sections::SECTIONS;

const USAGE: &str = "cargo run --example report -- [OPTIONS]

  --quick          small pictures, few repetitions, the first few of many styles and
                   models, no other crates; sections run at the same time, so times mean little
  --rounds N       repetitions of every variant; default 7, with --quick 1
  --out FOLDER     folder of the report; default docs/report
  --only SECTION   measure this section only; may be given several times: machine, ranges, lines, models,
                   dashes, history, straight, page, stability, ladder, parts, scene-parts, toon,
                   growth, many-objects, peers, peer-objects, flicker or soak
  --tables         write the CSV files alone, without text and plots
  --render         measure nothing; write text and plots from the CSV files

Without --only, everything is measured but soak, which draws 100,000 frames and has no times. Date, commit
and seconds of each section are written to sections.csv in the folder of the report.

The sections peers and peer-objects build tools/peers; peers starts the program that the variable PEERS_PROGRAM names,
also with --quick.";

/// What the command line asks for.
pub struct Arguments {
    pub quick: bool,
    pub render: bool,
    pub tables: bool,
    /// Repetitions of every variant, where they are not those of the report.
    pub rounds: Option<NonZero<usize>>,
    /// The sections to measure; empty for all of the report.
    pub only: Vec<String>,
    pub out: PathBuf,
}

impl Arguments {
    /// `None` when only help was asked for.
    pub fn parse() -> Result<Option<Self>, String> {
        let read = Self::read(lexopt::Parser::from_env())
            .map_err(|message| format!("{message}\n\n{USAGE}"))?;
        if read.is_none() {
            println!("{USAGE}");
        }
        Ok(read)
    }

    /// `None` when help was asked for.
    fn read(mut parser: lexopt::Parser) -> Result<Option<Self>, String> {
        use lexopt::prelude::*;
        let wrong = |error: lexopt::Error| error.to_string();
        let mut read = Self {
            quick: false,
            render: false,
            tables: false,
            rounds: None,
            only: Vec::new(),
            out: PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/report")),
        };
        while let Some(argument) = parser.next().map_err(wrong)? {
            match argument {
                Long("quick") => read.quick = true,
                Long("render") => read.render = true,
                Long("tables") => read.tables = true,
                Long("rounds") => {
                    let rounds = parser.value().and_then(|value| value.parse());
                    read.rounds = Some(rounds.map_err(wrong)?);
                }
                Long("out") => read.out = parser.value().map_err(wrong)?.into(),
                Long("only") => {
                    let name = parser.value().and_then(|v| v.string()).map_err(wrong)?;
                    if !SECTIONS.iter().any(|section| section.name == name) {
                        return Err(format!("no section {name:?}"));
                    }
                    read.only.push(name);
                }
                Short('h') | Long("help") => return Ok(None),
                other => return Err(wrong(other.unexpected())),
            }
        }
        Ok(Some(read))
    }
}

#[cfg(test)]
mod tests {
    use bevy_comics_testkit::fuzz::{Counting, check_command_lines};

    use super::*;

    #[global_allocator]
    static ALLOCATOR: Counting = Counting;

    /// Command lines with an argument on each line.
    const RIGHT: [&str; 6] = [
        "--quick\n--out\ntarget/report",
        "--only\nflicker\n--tables",
        "--render\n--out=folder",
        "--quick\n--only=scene-parts\n--tables\n--only\nparts",
        "--rounds\n3\n--only\nladder",
        "--help",
    ];

    /// Every command line is read, or refused with a message.
    #[test]
    fn parsing_a_command_line_never_panics() {
        check_command_lines(
            5,
            &RIGHT,
            |given| Arguments::read(lexopt::Parser::from_args(given)),
            |arguments| {
                let known = |name: &String| SECTIONS.iter().any(|s| s.name == name);
                assert!(arguments.only.iter().all(known));
            },
        );
    }

    /// Every section that is named is measured.
    #[test]
    fn several_sections_may_be_named() {
        let given = ["--only", "parts", "--only=toon"];
        let read = Arguments::read(lexopt::Parser::from_args(given));
        let read = read.expect("a right command line").expect("no help");
        assert_eq!(read.only, ["parts", "toon"]);
    }

    /// A section without a repetition would have no times.
    #[test]
    fn no_rounds_are_refused() {
        let read = |rounds| Arguments::read(lexopt::Parser::from_args(["--rounds", rounds]));
        let some = read("3").expect("a right command line").expect("no help");
        assert_eq!(some.rounds, NonZero::new(3));
        for wrong in ["0", "-1", "some", ""] {
            assert!(read(wrong).is_err(), "{wrong:?} is read");
        }
    }

    /// The help names every section.
    #[test]
    fn the_help_names_every_section() {
        let words: Vec<&str> = USAGE.split([' ', ',', '\n']).collect();
        for section in SECTIONS {
            assert!(words.contains(&section.name), "{}", section.name);
        }
    }
}
