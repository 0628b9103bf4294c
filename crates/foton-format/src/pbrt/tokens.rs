//! The text of a pbrt file as tokens, each with its place. What they mean together is the reader's.

use std::borrow::Cow;

use foton_input::quoted;
use foton_math::Cancel;

use crate::diagnostic::Place;

/// A token.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token<'t> {
    /// A name of a directive, or `true` and its like.
    Word(&'t str),
    /// What stood in quotes.
    Text(Cow<'t, str>),
    /// A finite number.
    Number(f64),
    /// `[`
    Open,
    /// `]`
    Close,
}

/// A token and where it stands; a text stands where its contents begin, so that these are what an excerpt marks.
pub(crate) type Placed<'t> = (Token<'t>, Place);

/// Goes over a text.
#[derive(Clone)]
pub(crate) struct Tokens<'t> {
    text: &'t str,
    at: usize,
    place: Place,
    cancel: Option<&'t Cancel>,
}

/// What is wrong with a token, and where.
pub(crate) type Fault = (Place, String);

impl<'t> Tokens<'t> {
    /// Of a text that has so many lines of other files before it.
    pub(crate) const fn new(text: &'t str, lines_before: u32) -> Self {
        Self { text, at: 0, place: Place { line: lines_before.saturating_add(1), column: 1 }, cancel: None }
    }

    /// The same, whose long lists end once that is requested.
    pub(crate) const fn until(self, cancel: &'t Cancel) -> Self {
        Self { cancel: Some(cancel), ..self }
    }

    /// Whether to stop, asked after so many values of a list.
    pub(crate) fn is_cancelled_at(&self, count: usize) -> bool {
        self.cancel.is_some_and(|cancel| cancel.check_at(count).is_err())
    }

    /// How much of the text is behind, from 0 to 1.
    pub(crate) fn share(&self) -> f64 {
        self.at as f64 / self.text.len().max(1) as f64
    }

    /// Where the next token begins, or the text ends.
    pub(crate) fn place(&mut self) -> Place {
        self.skip_blanks();
        self.place
    }

    /// The next token without going over it.
    pub(crate) fn peek(&self) -> Option<Result<Placed<'t>, Fault>> {
        self.clone().next()
    }

    fn advance(&mut self, bytes: usize) {
        for &byte in &self.text.as_bytes()[self.at..self.at + bytes] {
            if byte == b'\n' {
                self.place.line = self.place.line.saturating_add(1);
                self.place.column = 1;
            } else if byte & 0xc0 != 0x80 {
                // Bytes that go on with a character have no column of their own.
                self.place.column = self.place.column.saturating_add(1);
            }
        }
        self.at += bytes;
    }

    fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    /// Goes over white space and comments.
    fn skip_blanks(&mut self) {
        loop {
            let rest = self.rest();
            let blank = rest.len() - rest.trim_start().len();
            self.advance(blank);
            if !self.rest().starts_with('#') {
                return;
            }
            let comment = self.rest().find('\n').unwrap_or(self.rest().len());
            self.advance(comment);
        }
    }

    /// A text in quotes; what goes over the end of its line has none.
    fn quoted(&mut self) -> Result<Placed<'t>, Fault> {
        let begin = self.place;
        self.advance(1);
        let (place, rest) = (self.place, self.rest());
        let mut escaped = false;
        for (i, c) in rest.char_indices() {
            match c {
                '\n' => break,
                '\\' if !escaped => {
                    escaped = true;
                    continue;
                }
                '"' if !escaped => {
                    let text = &rest[..i];
                    self.advance(i + 1);
                    return match unescaped(text) {
                        Some(text) => Ok((Token::Text(text), place)),
                        None => {
                            Err((place, "a backslash stands before none of b f n r t \\ ' \"".to_owned()))
                        }
                    };
                }
                _ => {}
            }
            escaped = false;
        }
        // On with the next line.
        self.advance(rest.find('\n').unwrap_or(rest.len()));
        Err((begin, "the text in quotes has no end on its line".to_owned()))
    }

    fn word(&mut self) -> Result<Placed<'t>, Fault> {
        let (rest, place) = (self.rest(), self.place);
        let is_end = |c: char| c.is_whitespace() || matches!(c, '"' | '[' | ']' | '#');
        let word = &rest[..rest.find(is_end).unwrap_or(rest.len())];
        self.advance(word.len());
        if !word.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) {
            return Ok((Token::Word(word), place));
        }
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok((Token::Number(number), place)),
            Ok(_) => Err((place, format!("{} is not a finite number", quoted(word)))),
            Err(_) => Err((place, format!("{} is not a number", quoted(word)))),
        }
    }
}

impl<'t> Iterator for Tokens<'t> {
    type Item = Result<Placed<'t>, Fault>;

    fn next(&mut self) -> Option<Self::Item> {
        self.skip_blanks();
        let place = self.place;
        let token = match self.rest().as_bytes().first()? {
            b'"' => return Some(self.quoted()),
            b'[' => Token::Open,
            b']' => Token::Close,
            _ => return Some(self.word()),
        };
        self.advance(1);
        Some(Ok((token, place)))
    }
}

/// A text with its escapes replaced; `None` where a backslash means nothing.
fn unescaped(text: &str) -> Option<Cow<'_, str>> {
    if !text.contains('\\') {
        return Some(Cow::Borrowed(text));
    }
    let mut plain = String::with_capacity(text.len());
    let mut letters = text.chars();
    while let Some(c) = letters.next() {
        plain.push(if c == '\\' {
            match letters.next()? {
                'b' => '\u{8}',
                'f' => '\u{c}',
                'n' => '\n',
                'r' => '\r',
                't' => '\t',
                c @ ('\\' | '\'' | '"') => c,
                _ => return None,
            }
        } else {
            c
        });
    }
    Some(Cow::Owned(plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<Result<Placed<'_>, Fault>> {
        Tokens::new(text, 0).collect()
    }

    #[test]
    fn tokens_stand_where_they_begin_and_texts_where_their_contents_do() {
        let at = |line, column| Place { line, column };
        let text = "Shape\"é\" # [ \"\n [-.5e1]true\t\"a\\\"b\\\\\" 1e999 1x";
        let found = all(text);
        let wanted = [
            Ok((Token::Word("Shape"), at(1, 1))),
            Ok((Token::Text("é".into()), at(1, 7))),
            Ok((Token::Open, at(2, 2))),
            Ok((Token::Number(-5.0), at(2, 3))),
            Ok((Token::Close, at(2, 8))),
            Ok((Token::Word("true"), at(2, 9))),
            Ok((Token::Text("a\"b\\".into()), at(2, 15))),
            Err((at(2, 23), "\"1e999\" is not a finite number".to_owned())),
            Err((at(2, 29), "\"1x\" is not a number".to_owned())),
        ];
        assert_eq!(found, wanted);
    }

    #[test]
    fn a_text_without_an_end_costs_no_more_than_its_line() {
        let found = all("\"a\nb \"c\\x\" \"");
        assert!(found[0].is_err() && found[2].is_err() && found[3].is_err() && found.len() == 4, "{found:?}");
        assert_eq!(found[1], Ok((Token::Word("b"), Place { line: 2, column: 1 })));
    }
}
