//! The line of a scene file that a finding is about, as it may be shown: printable, of bearable length, with the part that is meant.

use foton_input::is_printable;

/// The most characters of a line that are shown, and how many of them stand before what is meant.
const MAX_SHOWN: usize = 140;
const BEFORE: usize = 50;

/// A line of a file, and what is meant in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The line, or of a long one the part around what is meant: printable, each character one wide as a rule.
    pub line: String,
    /// Where in it begins what is meant, in characters, from 0.
    pub column: usize,
    /// How many characters are meant, at least 1.
    pub length: usize,
}

impl Excerpt {
    /// Of a line, for a place in it: a column in characters, from 1, or 0 for all of the line.
    pub(crate) fn of(line: &str, column: u32) -> Self {
        let column = column as usize;
        let shown = |c: char| if c == ' ' || is_printable(c) { c } else { ' ' };
        let begin = column.saturating_sub(BEFORE + 1);
        let is_long = line.chars().nth(MAX_SHOWN).is_some();
        let begin = if is_long { begin } else { 0 };
        let mut part: Vec<char> = line.trim_end().chars().skip(begin).map(shown).collect();
        if column == 0 {
            let first = part.iter().position(|c| *c != ' ').unwrap_or(0);
            part.truncate(MAX_SHOWN);
            let length = part.len().saturating_sub(first).max(1);
            return Self { line: part.into_iter().collect(), column: first, length };
        }
        let at = (column - 1 - begin).min(part.len());
        let length = meant(&part, at);
        if begin > 0 {
            part[0] = '…';
        }
        if part.len() > MAX_SHOWN {
            part.truncate(MAX_SHOWN);
            part.push('…');
        }
        let length = length.min(part.len().saturating_sub(at)).max(1);
        Self { line: part.into_iter().collect(), column: at, length }
    }
}

/// How many characters of a line a place means: all of a value in quotes, the beginning of a tag, or a name.
fn meant(line: &[char], at: usize) -> usize {
    let rest = &line[at..];
    let quote = at.checked_sub(1).map(|before| line[before]).filter(|c| matches!(c, '"' | '\''));
    let end = match quote {
        Some(quote) => rest.iter().position(|c| *c == quote),
        None => {
            let tag = usize::from(rest.first() == Some(&'<'));
            let is_end = |c: &char| c.is_whitespace() || matches!(c, '=' | '>' | '/' | '<' | '"' | '\'');
            rest.iter().skip(tag).position(is_end).map(|end| end + tag)
        }
    };
    end.unwrap_or(rest.len()).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The line with marks under what is meant.
    fn marked(line: &str, column: u32) -> [String; 2] {
        let Excerpt { line, column, length } = Excerpt::of(line, column);
        [line, " ".repeat(column) + &"^".repeat(length)]
    }

    #[test]
    fn values_tags_and_names_are_marked() {
        let line = "\t<float name=\"radus\" value='é 2'/> \r";
        for (column, marks) in [
            (2, " ^^^^^^"),
            (9, "        ^^^^"),
            (15, "              ^^^^^"),
            (29, "                            ^^^"),
            (0, " ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"),
            (60, "                                  ^"),
        ] {
            assert_eq!(marked(line, column), [" <float name=\"radus\" value='é 2'/>", marks], "{column}");
        }
        assert_eq!(marked("<a b=''/>", 7), ["<a b=''/>", "      ^"]);
        assert_eq!(marked("", 1), ["", "^"]);
    }

    #[test]
    fn of_a_long_line_the_part_around_the_place_is_shown() {
        let line = format!("{}<a b='c'/>{}", "x".repeat(1000), "y".repeat(1000));
        let [shown, marks] = marked(&line, 1007);
        assert_eq!(
            shown,
            format!("…{}<a b='c'/>{}…", "x".repeat(BEFORE - 7), "y".repeat(MAX_SHOWN - BEFORE - 4))
        );
        assert_eq!(marks, format!("{}^", " ".repeat(BEFORE)));
        assert_eq!(Excerpt::of(&line, 0).length, MAX_SHOWN);
        let word = "z".repeat(500);
        assert_eq!(
            Excerpt::of(&word, 1),
            Excerpt { line: "z".repeat(MAX_SHOWN) + "…", column: 0, length: MAX_SHOWN + 1 }
        );
    }

    #[test]
    fn what_is_not_printable_is_not_shown() {
        assert_eq!(marked("a\u{1b}[2J b", 1)[0], "a [2J b");
    }
}
