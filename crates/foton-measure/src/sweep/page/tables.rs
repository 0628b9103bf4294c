//! The page's tables: the front by name, and what each arm of the star takes to get somewhere.

use super::Report;
use super::advice::{common_time, curves};
use super::figures::{is_on_star, three_digits};
use crate::plot::escape;
use crate::plot::short;

/// Shares whose times are told.
const GOALS: [f64; 3] = [0.1, 0.03, 0.01];

impl Report<'_> {
    /// The tables.
    pub(crate) fn times(&self) -> String {
        let curves = curves(self.points);
        let Some(time) = common_time(&curves) else { return String::new() };
        let mut rows = String::new();
        for curve in curves.iter().filter(|c| is_on_star(&c.configuration, &self.centre)) {
            let Some(last) = curve.points.last() else { continue };
            let cells: String = GOALS
                .iter()
                .map(|goal| curve.time_to(*goal).map_or_else(|| "–".to_owned(), seconds))
                .chain([curve.at(time).map_or_else(
                    || "–".to_owned(),
                    |(e, d)| format!("{} ± {}", three_digits(100.0 * e), three_digits(100.0 * d)),
                )])
                .chain(
                    [last.noise(1), last.bias(1), last.noise(2), last.bias(2)]
                        .map(|v| three_digits(100.0 * v)),
                )
                .chain([format!("{:.3}", last.flip), format!("{:.0}", last.bytes / f64::from(1 << 20))])
                .map(|cell| format!("<td>{cell}</td>"))
                .collect();
            let name = escape(&curve.configuration.to_string());
            let name = if curve.configuration == self.centre { format!("<b>{name}</b>") } else { name };
            rows += &format!("<tr><td>{name}</td>{cells}</tr>");
        }
        let front: String = self
            .front()
            .iter()
            .map(|p| {
                format!(
                    "<tr><td>{}</td><td>{}</td><td>{} ± {}</td><td>{}</td></tr>",
                    escape(&p.configuration.to_string()),
                    seconds(p.cpu),
                    three_digits(100.0 * p.error),
                    three_digits(100.0 * p.error_deviation),
                    p.pass
                )
            })
            .collect();
        format!(
            "<h2>The star</h2><p>Processor time to 10, 3 and 1 % error, error at {} s; then, after all passes, noise and bias in % \
             of smooth pixels and of edges, FLIP, and memory.</p><div class=\"wide\"><table><tr><th>configuration</th><th>to 10 %</th>\
             <th>to 3 %</th><th>to 1 %</th><th>error %</th><th>noise, smooth</th><th>bias, smooth</th><th>noise, edges</th>\
             <th>bias, edges</th><th>FLIP</th><th>MiB</th></tr>{rows}</table></div>\
             <h2>The Pareto front</h2><div class=\"wide\"><table><tr><th>configuration</th><th>time</th><th>error %</th><th>passes</th></tr>{front}\
             </table></div>",
            short(time)
        )
    }
}

/// Seconds with three digits.
fn seconds(v: f64) -> String {
    format!("{} s", three_digits(v))
}
