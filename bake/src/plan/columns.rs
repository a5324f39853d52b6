//! A plan set in columns.

use crate::disk::manifest::EffectEntry;

/// Columns of a line.
const WIDTH: usize = 110;
/// Columns before an effect's name.
const MARGIN: usize = 6;
/// Columns before the text beside a heading.
const INDENT: usize = 28;

/// The effects, a block each: whether it is on, its name and why; then what it costs, and what toggles it. Lines are
/// wrapped at 110 columns.
pub fn in_words(entries: &[EffectEntry]) -> String {
    entries.iter().map(block).collect()
}

fn block(entry: &EffectEntry) -> String {
    let (state, cost, turned) = match entry.on {
        true => ("on", "costs", "off by"),
        false => ("off", "would cost", "on by"),
    };
    let heading = format!("  {state:<4}{}", entry.effect);
    let mut text = labelled(&heading, &entry.why);
    for (label, words) in [(cost, &entry.cost), (turned, &entry.toggled_by)] {
        if !words.is_empty() {
            text += &labelled(&format!("{:MARGIN$}{label}", ""), words);
        }
    }
    text
}

/// A short heading, and beside it a text wrapped into a column of its own.
pub fn labelled(heading: &str, text: &str) -> String {
    let lines = wrapped(text, WIDTH - INDENT);
    let line = |(i, line): (usize, String)| {
        let heading = if i == 0 { heading } else { "" };
        // A heading that fills its column keeps a space.
        format!("{heading:<width$} {line}\n", width = INDENT - 1)
    };
    lines.into_iter().enumerate().map(line).collect()
}

/// Lines of at most `width` columns, one at least; longer words stand alone.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let length = lines[last].chars().count();
        if length == 0 {
            lines[last].push_str(word);
        } else if length + 1 + word.chars().count() <= width {
            lines[last] += " ";
            lines[last] += word;
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(why: &str, cost: &str) -> EffectEntry {
        let (effect, toggled_by) = ("disc-lanes".to_owned(), String::new());
        EffectEntry { effect, on: false, why: why.into(), cost: cost.into(), toggled_by }
    }

    #[test]
    fn words_are_wrapped_into_their_column() {
        let text = in_words(&[entry("why ".repeat(50).trim(), "nothing")]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4, "{text}");
        assert!(lines.iter().all(|line| line.chars().count() <= WIDTH), "{text}");
        assert!(lines[1].starts_with(&" ".repeat(INDENT)) && lines[3].starts_with("      would cost"), "{text}");
    }

    #[test]
    fn what_an_older_set_does_not_say_takes_no_line() {
        assert_eq!(in_words(&[entry("so it is", "")]).lines().count(), 1);
    }
}
