//! One page of what a sweep found: self-contained HTML with inline SVG, readable without a network, by day and by night.

pub(crate) mod advice;
mod figures;
mod tables;

use super::plan::Configuration;
use super::reference::Reference;
use super::store::Shown;
use super::table::Point;
use crate::plot::{self, escape};

/// Everything that the page says.
pub(crate) struct Report<'a> {
    pub(crate) name: &'a str,
    pub(crate) identity: &'a str,
    pub(crate) centre: Configuration,
    pub(crate) reference: &'a Reference,
    pub(crate) points: &'a [Point],
    pub(crate) pictures: &'a [Shown],
}

const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#1b1f24;--dim:#59636e;--line:#d1d9e0;--back:#fff;--card:#f6f8fa}\
@media(prefers-color-scheme:dark){:root{--ink:#e6edf3;--dim:#9198a1;--line:#3d444d;--back:#0d1117;--card:#151b23}}\
*{box-sizing:border-box}\
body{margin:0 auto;max-width:76rem;padding:2rem 1.25rem 4rem;background:var(--back);color:var(--ink);\
font:15px/1.55 system-ui,-apple-system,'Segoe UI',Roboto,sans-serif}\
h1{font-size:1.7rem;margin:0 0 .25rem}h2{font-size:1.2rem;margin:2.5rem 0 .5rem}\
p{max-width:62rem}small,.dim,figcaption{color:var(--dim)}\
.advice{font-size:1.15rem;border-left:4px solid #0072b2;background:var(--card);padding:.8rem 1rem;border-radius:0 6px 6px 0}\
.advice code{font-size:.95rem}\
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,34rem),1fr));gap:1.25rem}\
figure{margin:0;background:var(--card);border:1px solid var(--line);border-radius:8px;padding:.75rem}\
figcaption{font-size:.85rem;line-height:1.4;margin-top:.4rem}\
svg{display:block;width:100%;height:auto}svg .on-light{fill:#10151a}svg .on-dark{fill:#fff}svg .hole{fill:none;stroke:var(--line)}\
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(11rem,1fr));gap:1rem}\
.pictures img{display:block;width:100%;image-rendering:pixelated;border-radius:4px;margin-bottom:4px}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums}th,td{padding:.25rem .7rem;text-align:right;\
border-bottom:1px solid var(--line)}td{white-space:nowrap}th:first-child,td:first-child{text-align:left}th{color:var(--dim);font-weight:600}\
.wide{overflow-x:auto}";

impl Report<'_> {
    /// The page.
    pub(crate) fn html(&self) -> String {
        let name = escape(self.name);
        let plots = [
            self.error_per_alpha(),
            self.pareto(),
            self.plane(),
            self.error_per_radius(),
            self.error_per_rule(),
            self.parts(),
            self.classes(),
        ];
        let plots: String = plots.into_iter().flatten().collect();
        format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
             <title>{name}: what accuracy costs</title><style>{STYLE}{}{}</style></head><body>\n\
             <h1>{name}: what accuracy costs</h1>\n<p class=\"dim\">{}</p>\n{}\n\
             <h2>Error and time</h2><div class=\"plots\">{plots}</div>\n{}\n{}\n{}\n</body></html>\n",
            plot::STYLE,
            plot::colours::style(),
            escape(self.identity),
            self.advice(),
            self.images(),
            self.times(),
            self.method(),
        )
    }

    fn advice(&self) -> String {
        let Some(advice) = advice::recommend(self.name, &self.centre, self.points) else {
            return "<p class=\"advice\">Nothing ran: there is nothing to recommend.</p>".to_owned();
        };
        format!(
            "<p class=\"advice\">{}<br><code>foton render … {}</code></p>",
            escape(&advice.sentence),
            escape(&advice.best.options())
        )
    }

    fn images(&self) -> String {
        if self.pictures.is_empty() {
            return String::new();
        }
        let picture = |bytes: &[u8], alt: &str| {
            format!("<img src=\"data:image/png;base64,{}\" alt=\"{}\">", base64(bytes), escape(alt))
        };
        let mut cards = String::new();
        for shown in self.pictures {
            let error = shown.error.as_ref();
            let map = error.map_or_else(String::new, |e| picture(e, &format!("error of {}", shown.title)));
            cards += &format!(
                "<figure>{}{map}<figcaption><b>{}</b><br>{}</figcaption></figure>",
                picture(&shown.image, &shown.title),
                escape(&shown.title),
                escape(&shown.detail)
            );
        }
        format!(
            "<h2>Images at equal time</h2><p>The first seed, at about the same processor time. Below each image its relative error, \
             from dark blue (none) to yellow.</p><div class=\"pictures\">{cards}</div>"
        )
    }

    fn method(&self) -> String {
        let r = self.reference;
        let noise = if r.noise() > 0.0 {
            format!(
                "Its own noise is {:.2} % of the mean light (root mean square by pixel); its square is taken off squared errors.",
                100.0 * r.noise()
            )
        } else {
            "Its own noise is not known, and counts as error; so does what the runs' eye samples miss."
                .to_owned()
        };
        let seeds = self.points.iter().map(|p| p.seeds).max().unwrap_or(0);
        format!(
            "<h2>How this was measured</h2><p>Error is the root mean square error of luminance over the pixels that see something reflect, \
             divided by their mean reflected light. All runs see the same eye samples, so antialiasing is no part of it; {seeds} seeds a \
             configuration differ in their photons. Bias and noise come apart between seeds: noise is what differs, bias what does not. \
             <b>Smooth</b> pixels ({:.0} % of those seen) show one shape for 3 pixels around and light that varies little there, fixed \
             beforehand from the reference; the rest are <b>edges</b>.</p>\
             <p>Times are processor seconds of all threads, which other programs on the machine change little; a run's wall time is about \
             that divided by the threads. Runs that share their photons are charged for tracing as if alone.</p>\
             <p>The reference is {}. {noise}</p><p>Tables: <code>summary.csv</code>, <code>runs.csv</code> beside this page.</p>",
            100.0 * r.masks.smooth_share(),
            escape(&r.origin),
        )
    }
}

/// Bytes in base 64, as data URIs have them.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().fold(0u32, |word, &b| word << 8 | u32::from(b)) << (8 * (3 - chunk.len()));
        for digit in 0..4 {
            if digit <= chunk.len() {
                text.push(char::from(DIGITS[(word >> (18 - 6 * digit) & 63) as usize]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_in_base_64_are_those_of_the_standard() {
        // RFC 4648, section 10.
        for (plain, coded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
        assert_eq!(escape("a<b & \"c\""), "a&lt;b &amp; &quot;c&quot;");
    }
}
