//! Findings in a scene file as compilers show them: the message, the line, a mark under what is meant, and what to do.

use std::io::{IsTerminal, stderr};

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use foton_format::{Diagnostic, Excerpt, Severity};
use foton_input::printable;

/// Lines of files are cut before they are as long.
const WIDTH: usize = 250;

/// A finding as text without its severity, with the line that it is about where `has_line` says so.
#[cfg(feature = "window")]
pub(crate) fn text(d: &Diagnostic, has_line: bool) -> String {
    let text = rendered(d, has_line, Renderer::plain());
    text.strip_prefix("error: ").or_else(|| text.strip_prefix("warning: ")).unwrap_or(&text).to_owned()
}

/// A finding for standard error: in colours on a terminal, unless `NO_COLOR` says that there are to be none.
pub(crate) fn for_terminal(d: &Diagnostic, has_line: bool) -> String {
    let has_colours =
        stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    rendered(d, has_line, if has_colours { Renderer::styled() } else { Renderer::plain() })
}

fn rendered(d: &Diagnostic, has_line: bool, renderer: Renderer) -> String {
    let level = match d.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut group = Group::with_title(level.primary_title(d.to_string()));
    if let Some(Excerpt { line, column, length }) = d.excerpt.as_ref().filter(|_| has_line) {
        // Annotations go by bytes.
        let byte = |at: usize| line.char_indices().nth(at).map_or(line.len(), |(byte, _)| byte);
        let mark = AnnotationKind::Primary.span(byte(*column)..byte(column + length));
        group = group.element(Snippet::source(line).line_start(d.line as usize).annotation(mark));
    }
    if let Some(help) = &d.help {
        group = group.element(Level::HELP.message(printable(help)));
    }
    renderer.term_width(WIDTH).render(&[group])
}

#[cfg(test)]
mod tests {
    use foton_format::{Options, read_str};

    use super::*;

    fn found(xml: &str) -> Vec<Diagnostic> {
        let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
        read_str("room.xml", xml, &no_files, &Options::default())
            .expect_err("an error")
            .diagnostics()
            .to_vec()
    }

    #[test]
    fn a_finding_shows_its_line_with_a_mark_and_what_to_do() {
        let found = found(
            "<scene version='3.0.0'>\n  <sensor type='perspective'/>\n  <shape type='cube' id='größe'><bsdf type='dielectrc'/></shape>\n</scene>",
        );
        let text = rendered(&found[0], true, Renderer::plain());
        let wanted = "error: room.xml:3:45: unknown bsdf \"dielectrc\", did you mean \"dielectric\"?
  |
3 |   <shape type='cube' id='größe'><bsdf type='dielectrc'/></shape>
  |                                             ^^^^^^^^^
  |
  = help: the bsdf plugins that foton reads are ";
        assert!(text.starts_with(wanted), "{text}");
        let short = rendered(&Diagnostic { help: None, ..found[0].clone() }, false, Renderer::plain());
        assert_eq!(short, wanted.lines().next().expect("a line"));
        assert!(rendered(&found[0], true, Renderer::styled()).contains("\u{1b}["));
    }

    #[test]
    fn nothing_in_a_file_gives_orders_to_a_terminal() {
        let found = found(
            "<scene version='3.0.0'>\n<shape type='\u{9b}31m\u{202e}x'/><float nam='&#x9b;0m'/></scene>",
        );
        for finding in &found {
            let text = rendered(finding, true, Renderer::plain());
            assert!(text.lines().all(|line| printable(line) == line), "{text:?}");
        }
    }
}
