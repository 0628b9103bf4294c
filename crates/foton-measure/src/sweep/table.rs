//! Results as tidy tables: a row a run and judged pass, and a row for all seeds together. The second is read back.

use std::collections::HashMap;
use std::fmt::Write;
use std::num::NonZeroU32;

use foton_integrator::{Alpha, DirectLight, RadiusFloor, RadiusRule, RadiusScale, Stage};

use super::judge::{Spread, Squares};
use super::plan::Configuration;
use super::run::{Finished, Gathered, Row};

/// Parts of the image in the names of columns.
const MASKS: [&str; 3] = ["seen", "smooth", "edge"];
const CLASSES: [&str; 3] = ["direct", "caustic", "indirect"];
const CONFIGURATION: &str = "alpha,photons_per_pass,radius_scale,radius_floor,radius_rule,direct";

/// One configuration at one pass: means over seeds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) configuration: Configuration,
    pub(crate) pass: u64,
    pub(crate) photons: u64,
    pub(crate) seeds: u64,
    /// Processor seconds of a run of its own.
    pub(crate) cpu: f64,
    pub(crate) wall: f64,
    pub(crate) bytes: f64,
    pub(crate) unknown: f64,
    /// Share of the mean light: of all that is seen, and its standard deviation between seeds.
    pub(crate) error: f64,
    pub(crate) error_deviation: f64,
    pub(crate) rmse: f64,
    pub(crate) rel_mse: f64,
    pub(crate) flip: f64,
    pub(crate) spread: Spread,
}

impl Point {
    /// √variance of a part: all, smooth, edge.
    pub(crate) fn noise(&self, mask: usize) -> f64 {
        self.spread.masks[mask].variance.max(0.0).sqrt()
    }

    /// √bias² of a part; zero where chance took it below.
    pub(crate) fn bias(&self, mask: usize) -> f64 {
        self.spread.masks[mask].bias2.max(0.0).sqrt()
    }

    /// √(variance + bias²) of a part.
    pub(crate) fn total(&self, mask: usize) -> f64 {
        let Squares { variance, bias2 } = self.spread.masks[mask];
        (variance + bias2).max(0.0).sqrt()
    }

    pub(crate) fn of(gathered: &Gathered) -> Option<Self> {
        let rows = &gathered.rows;
        let first = rows.first()?;
        let n = rows.len() as f64;
        let mean = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).sum::<f64>() / n;
        let error = mean(&|r| r.judged.error[0]);
        let scatter: f64 = rows.iter().map(|r| (r.judged.error[0] - error).powi(2)).sum();
        Some(Self {
            configuration: first.configuration,
            pass: first.report.pass,
            photons: first.report.photons,
            seeds: rows.len() as u64,
            cpu: mean(&|r| r.spent.cpu),
            wall: mean(&|r| r.spent.wall),
            bytes: mean(&|r| r.bytes as f64),
            unknown: mean(&|r| r.report.no_photon_share),
            error,
            error_deviation: (scatter / (n - 1.0).max(1.0)).sqrt(),
            rmse: mean(&|r| r.judged.rmse),
            rel_mse: mean(&|r| r.judged.rel_mse),
            flip: mean(&|r| r.judged.flip),
            spread: gathered.spread.clone(),
        })
    }
}

/// The heading of the table of runs.
pub(crate) fn runs_heading() -> String {
    let stages: String = Stage::ALL.iter().map(|s| format!(",{}_cpu_s", s.name())).collect();
    format!(
        "{CONFIGURATION},seed,pass,photons,cpu_s,wall_s,bytes,photons_stored,no_photon_share,radii_at_floor,error,error_smooth,\
         error_edge,rmse,rel_mse,flip{stages}\n"
    )
}

/// The table of runs without its heading.
pub(crate) fn runs(finished: &Finished) -> String {
    let mut text = String::new();
    for row in finished.gathered.iter().flat_map(|g| &g.rows) {
        let (r, j) = (&row.report, &row.judged);
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "{},{},{},{},{:.6},{:.6},{},{},{},{},{},{},{},{},{},{}",
            configuration(&row.configuration),
            row.seed,
            r.pass,
            r.photons,
            row.spent.cpu,
            row.spent.wall,
            row.bytes,
            r.stored,
            r.no_photon_share,
            r.floored,
            j.error[0],
            j.error[1],
            j.error[2],
            j.rmse,
            j.rel_mse,
            j.flip,
        );
        row.stages.iter().for_each(|s| {
            let _ = write!(text, ",{:.6}", s.cpu);
        });
        text.push('\n');
    }
    text
}

/// The heading of the table of all seeds together.
pub(crate) fn summary_heading() -> String {
    let squares = |names: [&str; 3]| names.map(|n| format!(",variance_{n},bias2_{n}")).concat();
    format!(
        "{CONFIGURATION},pass,photons,seeds,cpu_s,wall_s,bytes,no_photon_share,error,error_deviation,rmse,rel_mse,flip{}{}\n",
        squares(MASKS),
        squares(CLASSES)
    )
}

/// The table of all seeds together without its heading.
pub(crate) fn summary(points: &[Point]) -> String {
    let squares =
        |s: Option<&Squares>| s.map_or_else(|| ",,".to_owned(), |s| format!(",{},{}", s.variance, s.bias2));
    points
        .iter()
        .map(|p| {
            let masks: String = p.spread.masks.iter().map(|s| squares(Some(s))).collect();
            let classes: String = (0..3).map(|i| squares(p.spread.classes.as_ref().map(|c| &c[i]))).collect();
            format!(
                "{},{},{},{},{:.6},{:.6},{:.0},{},{},{},{},{},{}{masks}{classes}\n",
                configuration(&p.configuration),
                p.pass,
                p.photons,
                p.seeds,
                p.cpu,
                p.wall,
                p.bytes,
                p.unknown,
                p.error,
                p.error_deviation,
                p.rmse,
                p.rel_mse,
                p.flip
            )
        })
        .collect()
}

fn configuration(c: &Configuration) -> String {
    let rule = c.radius_rule.name();
    let direct = c.direct_light.name();
    format!("{},{},{},{},{rule},{direct}", c.alpha, c.photons, c.radius_scale, c.radius_floor)
}

/// Reads a [`summary`] with its heading; `None` if it is none.
pub(crate) fn read_summary(text: &str) -> Option<Vec<Point>> {
    let heading = summary_heading();
    let rows = text.strip_prefix(&heading)?;
    let names: Vec<&str> = heading.trim_end().split(',').collect();
    rows.lines()
        .map(|line| {
            let values: Vec<&str> = line.split(',').collect();
            (values.len() == names.len()).then_some(())?;
            read_point(&names.iter().copied().zip(values).collect())
        })
        .collect()
}

fn read_point(fields: &HashMap<&str, &str>) -> Option<Point> {
    let number = |name: &str| fields.get(name)?.parse::<f64>().ok();
    let whole = |name: &str| fields.get(name)?.parse::<u64>().ok();
    let squares = |name: &str| {
        Some(Squares {
            variance: number(&format!("variance_{name}"))?,
            bias2: number(&format!("bias2_{name}"))?,
        })
    };
    let [seen, smooth, edge] = MASKS.map(squares);
    let [direct, caustic, indirect] = CLASSES.map(squares);
    let classes = direct.zip(caustic).zip(indirect).map(|((d, c), i)| [d, c, i]);
    Some(Point {
        configuration: Configuration {
            alpha: Alpha::new(number("alpha")?)?,
            photons: NonZeroU32::new(u32::try_from(whole("photons_per_pass")?).ok()?)?,
            radius_scale: RadiusScale::new(number("radius_scale")?)?,
            radius_floor: RadiusFloor::new(number("radius_floor")?)?,
            radius_rule: RadiusRule::from_name(fields.get("radius_rule")?)?,
            direct_light: DirectLight::from_name(fields.get("direct")?)?,
        },
        pass: whole("pass")?,
        photons: whole("photons")?,
        seeds: whole("seeds")?,
        cpu: number("cpu_s")?,
        wall: number("wall_s")?,
        bytes: number("bytes")?,
        unknown: number("no_photon_share")?,
        error: number("error")?,
        error_deviation: number("error_deviation")?,
        rmse: number("rmse")?,
        rel_mse: number("rel_mse")?,
        flip: number("flip")?,
        spread: Spread { masks: [seen?, smooth?, edge?], classes },
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use foton_integrator::RenderSettings;

    /// A point at some time with some error.
    pub(crate) fn point(configuration: Configuration, cpu: f64, error: f64) -> Point {
        let squares = Squares { variance: 0.5 * error * error, bias2: 0.5 * error * error };
        Point {
            configuration,
            pass: 8,
            photons: 1 << 20,
            seeds: 5,
            cpu,
            wall: cpu,
            bytes: 1e6,
            unknown: 0.01,
            error,
            error_deviation: 0.02 * error,
            rmse: error,
            rel_mse: error * error,
            flip: 0.1,
            spread: Spread { masks: [squares; 3], classes: None },
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        let centre = Configuration::of(&RenderSettings::default());
        let mut points = vec![point(centre, 1.5, 0.03), point(centre, 3.0, 0.02)];
        points[1].spread.classes = Some([points[0].spread.masks[0]; 3]);
        points[1].configuration.direct_light = DirectLight::ShadowRays;
        let text = summary_heading() + &summary(&points);
        assert_eq!(read_summary(&text), Some(points));
        assert_eq!(read_summary(&text[..text.len() - 40]), None, "torn");
        assert_eq!(read_summary(&text.replace("adaptive", "adapt")), None);
        assert_eq!(read_summary(""), None);
    }
}
