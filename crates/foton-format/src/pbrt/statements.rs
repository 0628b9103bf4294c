//! What stands behind the name of a directive: numbers, names, and lists of parameters.

use std::cell::Cell;

use foton_input::{quoted, shown};

use super::parameters::{Kind, Parameter, Values};
use super::tokens::{Fault, Placed, Token, Tokens};
use crate::diagnostic::{Place, Report};
use crate::mitsuba::read::properties::Located;

/// The most parameters of a statement.
const MAX_PARAMETERS: usize = 1000;

/// A token as messages call it.
pub(crate) fn said(token: &Token<'_>) -> String {
    match token {
        Token::Word(word) => quoted(word),
        Token::Text(text) => format!("the text {}", quoted(text)),
        Token::Number(number) => format!("the number {number}"),
        Token::Open => "\"[\"".to_owned(),
        Token::Close => "\"]\"".to_owned(),
    }
}

impl<'t> Tokens<'t> {
    /// The next token, if it is of a kind that is wanted here.
    fn only<T>(&mut self, what: &str, of: impl Fn(&Token<'t>) -> Option<T>) -> Result<Located<T>, Fault> {
        let end = self.clone().place();
        match self.peek() {
            None => Err((end, format!("the file ends where {what} is needed"))),
            Some(Err(fault)) => {
                self.next();
                Err(fault)
            }
            Some(Ok((token, place))) => {
                let value = of(&token)
                    .ok_or_else(|| (place, format!("{} stands where {what} is needed", said(&token))))?;
                self.next();
                Ok(Located { value, place })
            }
        }
    }

    /// A text in quotes.
    pub(crate) fn text(&mut self, what: &str) -> Result<Located<String>, Fault> {
        self.only(what, |token| match token {
            Token::Text(text) => Some(text.clone().into_owned()),
            _ => None,
        })
    }

    /// A word without quotes.
    pub(crate) fn name(&mut self, what: &str) -> Result<Located<&'t str>, Fault> {
        self.only(what, |token| if let Token::Word(word) = token { Some(*word) } else { None })
    }

    /// So many numbers; brackets may stand around them.
    pub(crate) fn fixed<const N: usize>(&mut self) -> Result<[f64; N], Fault> {
        let has_bracket = matches!(self.peek(), Some(Ok((Token::Open, _))));
        if has_bracket {
            self.next();
        }
        let mut numbers = [0.0; N];
        for slot in &mut numbers {
            let number = |token: &Token<'_>| if let Token::Number(n) = token { Some(*n) } else { None };
            *slot = self.only("a number", number)?.value;
        }
        if has_bracket {
            self.only("\"]\"", |token| matches!(token, Token::Close).then_some(()))?;
        }
        Ok(numbers)
    }

    /// Goes on to the next word that may be a directive: those begin with a capital.
    pub(crate) fn skip_statement(&mut self) {
        loop {
            match self.peek() {
                None => return,
                Some(Ok((Token::Word(word), _))) if !word.starts_with(char::is_lowercase) => return,
                Some(_) => drop(self.next()),
            }
        }
    }

    /// A list of parameters; what is wrong with one is reported, and the others are read.
    pub(crate) fn parameters(&mut self, report: &mut Report) -> Vec<Parameter> {
        let mut list = Vec::new();
        while let Some(Ok((Token::Text(_), place))) = self.peek() {
            if list.len() >= MAX_PARAMETERS {
                report.error(place, format!("a statement has more than {MAX_PARAMETERS} parameters"));
                self.skip_statement();
                break;
            }
            match self.parameter() {
                Ok(parameter) => list.push(parameter),
                Err((place, message)) => {
                    report.error(place, message);
                    self.skip_value();
                }
            }
        }
        // What cannot be read here has no parameter to belong to.
        if let Some(Err((place, message))) = self.peek() {
            report.error(place, message);
            self.skip_statement();
        }
        list
    }

    /// Goes over the rest of a list of values that is wrong.
    fn skip_value(&mut self) {
        loop {
            match self.peek() {
                None | Some(Ok((Token::Word(_) | Token::Text(_), _))) => return,
                Some(_) => drop(self.next()),
            }
        }
    }

    fn parameter(&mut self) -> Result<Parameter, Fault> {
        let declared = self.text("a parameter")?;
        let words: Vec<&str> = declared.value.split_whitespace().collect();
        let [kind, name] = words[..] else {
            let message =
                format!("{} is not a type and a name, such as \"float radius\"", quoted(&declared.value));
            return Err((declared.place, message));
        };
        let kind = Kind::of(kind);
        let (values, value_place) = self.values(name, declared.place)?;
        let kind = kind.map_err(|message| (declared.place, message))?;
        let values = fitting(kind, values)
            .map_err(|what| (value_place, format!("{} is {what}", shown(&declared.value))))?;
        let place = declared.place;
        let (name, pictures, used) = (name.to_owned(), [None, None], Cell::new(false));
        Ok(Parameter { kind, name, place, value_place, values, pictures, used })
    }

    /// One value, or several in brackets.
    fn values(&mut self, name: &str, place: Place) -> Result<(Values, Place), Fault> {
        let missing = || (place, format!("the parameter {} has no value", quoted(name)));
        let before = self.clone();
        let Some(first) = self.next() else { return Err(missing()) };
        let (first, begin) = first?;
        let mut values: Option<Values> = None;
        match first {
            Token::Open => {}
            Token::Close => return Err((begin, "\"]\" closes nothing".to_owned())),
            // A directive that follows at once stays where it is.
            Token::Word(word) if truth(word).is_none() => {
                *self = before;
                return Err(missing());
            }
            one => {
                add(&mut values, (one, begin))?;
                return values.map(|values| (values, begin)).ok_or_else(missing);
            }
        }
        let value_place = self.clone().place();
        for count in 0.. {
            if self.is_cancelled_at(count) {
                break;
            }
            let before = self.clone();
            let Some(token) = self.next() else {
                return Err((begin, "the bracket is not closed".to_owned()));
            };
            match token? {
                (Token::Close, _) => {
                    return values.map(|values| (values, value_place)).ok_or_else(missing);
                }
                (Token::Open, place) => return Err((place, "a bracket stands inside a bracket".to_owned())),
                (Token::Word(word), _) if truth(word).is_none() => {
                    *self = before;
                    return Err((begin, "the bracket is not closed".to_owned()));
                }
                token => add(&mut values, token)?,
            }
        }
        // Nothing is said of a file whose reading was cancelled.
        Err(missing())
    }
}

/// `true` or `false`.
fn truth(word: &str) -> Option<bool> {
    match word {
        "true" => Some(true),
        "false" => Some(false),
        _ => None,
    }
}

/// Adds a value to those before it, which are of its kind.
fn add(values: &mut Option<Values>, (token, place): Placed<'_>) -> Result<(), Fault> {
    let mixed = || (place, "numbers, texts and truth values are mixed".to_owned());
    match (token, values) {
        (Token::Number(number), Some(Values::Numbers(numbers))) => numbers.push(number),
        (Token::Number(number), values @ None) => *values = Some(Values::Numbers(vec![number])),
        (Token::Text(text), Some(Values::Texts(texts))) => {
            texts.push(Located { value: text.into_owned(), place });
        }
        (Token::Text(text), values @ None) => {
            *values = Some(Values::Texts(vec![Located { value: text.into_owned(), place }]));
        }
        (Token::Word(word), values) => match (truth(word), values) {
            (Some(value), Some(Values::Booleans(all))) => all.push(value),
            (Some(value), values @ None) => *values = Some(Values::Booleans(vec![value])),
            _ => return Err(mixed()),
        },
        _ => return Err(mixed()),
    }
    Ok(())
}

/// Values as a type has them; otherwise what they must be.
fn fitting(kind: Kind, values: Values) -> Result<Values, &'static str> {
    match (kind, values) {
        (Kind::Bool, Values::Texts(texts)) => {
            let all: Option<Vec<bool>> = texts.iter().map(|text| truth(&text.value)).collect();
            all.map(Values::Booleans).ok_or("neither true nor false")
        }
        (Kind::Bool, values @ Values::Booleans(_)) => Ok(values),
        (Kind::Bool, _) => Err("neither true nor false"),
        (Kind::Text | Kind::Texture, values @ Values::Texts(_)) => Ok(values),
        (Kind::Text | Kind::Texture, _) => Err("no text in quotes"),
        (Kind::Spectrum, values @ (Values::Texts(_) | Values::Numbers(_))) => Ok(values),
        (_, values @ Values::Numbers(_)) => Ok(values),
        _ => Err("no number"),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn read(text: &str) -> (Vec<Parameter>, Vec<String>) {
        let mut report = Report::new("s", Path::new(""));
        let list = Tokens::new(text, 0).parameters(&mut report);
        let said = match report.finish() {
            Ok(all) => all,
            Err(e) => e.diagnostics().to_vec(),
        };
        (list, said.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn values_stand_in_brackets_or_alone() {
        let text = "\"float fov\" 45 \"rgb L\" [ 1 2 3 ] \"bool a\" \"true\" \"bool b\" [false] \"bool c\" true \
                    \"spectrum eta\" \"metal-Cu-eta\" \"string s\" [\"t\"] Shape";
        let (list, said) = read(text);
        let names: Vec<&str> = list.iter().map(|p| p.name.as_str()).collect();
        assert_eq!((names, said), (vec!["fov", "L", "a", "b", "c", "eta", "s"], vec![]));
        assert!(matches!(&list[1].values, Values::Numbers(n) if *n == [1.0, 2.0, 3.0]));
        assert!(matches!(&list[2].values, Values::Booleans(b) if *b == [true]));
    }

    #[test]
    fn every_fault_of_a_list_is_found() {
        let text = "\"flaot fov\" 45\n\"float\" 1\n\"float a\" \"x\"\n\"rgb b\" [1 \"x\"]\n\"float c\" 1x\n\"string d\" 1\n\"float e\" 1";
        let (list, said) = read(text);
        let wanted = [
            "s:1:2: \"flaot\" is no type of a parameter, did you mean \"float\"?",
            "s:2:2: \"float\" is not a type and a name, such as \"float radius\"",
            "s:3:12: float a is no number",
            "s:4:13: numbers, texts and truth values are mixed",
            "s:5:11: \"1x\" is not a number",
            "s:6:12: string d is no text in quotes",
        ];
        assert_eq!(said, wanted);
        assert_eq!(list.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["e"]);
    }

    #[test]
    fn a_directive_in_a_bracket_ends_it() {
        let (list, said) = read("\"float a\" [1 2 Shape \"sphere\"");
        assert_eq!((list.len(), &*said[0]), (0, "s:1:11: the bracket is not closed"));
    }
}
