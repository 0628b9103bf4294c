//! IES profiles: the candela of a measured lamp by direction, as files of LM-63 have them, to a table of even steps. `[LM63]`
//!
//! Type C alone, in which nearly all lamps are measured: vertical angles from straight down, horizontal ones about that axis.

use foton_math::Rgb;
use foton_scene::description::Bitmap;

/// Steps of the table to a degree: measured angles are multiples of half of one, or lie between its steps.
const STEPS: u32 = 2;

/// The most angles along either axis that a file may state.
const MAX_ANGLES: usize = 10_000;

/// A measured lamp.
struct Profile {
    /// In degrees, growing.
    vertical: Vec<f64>,
    horizontal: Vec<f64>,
    /// For each horizontal angle those of all vertical ones.
    candela: Vec<f64>,
}

/// The candela of a file: rows are angles from straight down, columns those about it. Of a lamp that is the same all around there is one
/// column.
///
/// # Errors
/// What is wrong with the file, in words.
pub(crate) fn read(bytes: &[u8]) -> Result<Bitmap, String> {
    let text: String = bytes.iter().copied().map(char::from).collect();
    let profile = Profile::parse(&text)?;
    let height = 180 * STEPS + 1;
    let width = if profile.horizontal.len() == 1 { 1 } else { 360 * STEPS };
    let pixels = (0..height).flat_map(|y| {
        let profile = &profile;
        (0..width).map(move |x| {
            let [about, from] = [(f64::from(x) + 0.5), f64::from(y)].map(|step| step / f64::from(STEPS));
            Rgb::splat(profile.candela(about, from) as f32)
        })
    });
    Ok(Bitmap::new(width, height, pixels.collect()))
}

impl Profile {
    fn parse(text: &str) -> Result<Self, String> {
        let (head, rest) = text.split_once("TILT=").ok_or("it has no line \"TILT=\"")?;
        if head.lines().next().is_some_and(|line| line.contains('\0')) {
            return Err("it is no text".to_owned());
        }
        let (tilt, numbers) = rest.split_once('\n').ok_or("it ends after \"TILT=\"")?;
        let mut numbers =
            Numbers(numbers.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()));
        match tilt.trim() {
            "NONE" => {}
            "INCLUDE" => {
                let _geometry = numbers.next()?;
                let count = numbers.count()?;
                for _ in 0..2 * count {
                    numbers.next()?;
                }
            }
            _ => return Err("its tilt is in a file of its own, which is not read".to_owned()),
        }
        let [_lamps, _lumens, multiplier] = [numbers.next()?, numbers.next()?, numbers.next()?];
        let [vertical, horizontal] = [numbers.count()?, numbers.count()?];
        match numbers.next()? {
            1.0 => {}
            2.0 => return Err("it is of type B, and only type C is read".to_owned()),
            3.0 => return Err("it is of type A, and only type C is read".to_owned()),
            _ => return Err("its type is none of 1 to 3".to_owned()),
        }
        let [_units, _width, _length, _height] =
            [numbers.next()?, numbers.next()?, numbers.next()?, numbers.next()?];
        let factor = multiplier * numbers.next()? * numbers.next()?;
        let _watts = numbers.next()?;
        let profile = Self {
            vertical: numbers.growing(vertical)?,
            horizontal: numbers.growing(horizontal)?,
            candela: (0..vertical * horizontal)
                .map(|_| Ok((numbers.next()? * factor).max(0.0)))
                .collect::<Result<_, String>>()?,
        };
        if profile.candela.iter().all(|c| c.is_finite()) {
            Ok(profile)
        } else {
            Err("it has infinite candela".to_owned())
        }
    }

    /// Candela at an angle about the axis, from 0 to 360°, and one from straight down.
    fn candela(&self, about: f64, from: f64) -> f64 {
        let last = self.horizontal[self.horizontal.len() - 1];
        let first = self.horizontal[0];
        // What is stated of a quarter or a half is the same, mirrored, in the others; a lamp of 90 to 270° is mirrored to the sides.
        let about = match (first, last) {
            (0.0, 90.0) => 90.0 - (about % 180.0 - 90.0).abs(),
            (0.0, 180.0) => 180.0 - (about - 180.0).abs(),
            (90.0, 270.0) if !(90.0..=270.0).contains(&about) => (540.0 - about) % 360.0,
            _ => about,
        };
        if from < self.vertical[0] || from > self.vertical[self.vertical.len() - 1] {
            return 0.0;
        }
        let (x, along_x) = between(&self.horizontal, about);
        let (y, along_y) = between(&self.vertical, from);
        let at = |x: usize, y: usize| {
            let [x, y] = [x.min(self.horizontal.len() - 1), y.min(self.vertical.len() - 1)];
            self.candela[x * self.vertical.len() + y]
        };
        let column = |x: usize| at(x, y) * (1.0 - along_y) + at(x, y + 1) * along_y;
        column(x) * (1.0 - along_x) + column(x + 1) * along_x
    }
}

/// The last of growing numbers up to one, and how far it is to the next.
fn between(numbers: &[f64], x: f64) -> (usize, f64) {
    let i = numbers.partition_point(|&n| n <= x).max(1) - 1;
    let share = numbers.get(i + 1).map_or(0.0, |next| (x - numbers[i]) / (next - numbers[i]));
    (i, share.clamp(0.0, 1.0))
}

/// Numbers of a file, one after the other.
struct Numbers<I>(I);

impl<'a, I: Iterator<Item = &'a str>> Numbers<I> {
    fn next(&mut self) -> Result<f64, String> {
        let word = self.0.next().ok_or("it ends too early")?;
        let number = word.parse::<f64>().ok().filter(|n| n.is_finite());
        number.ok_or_else(|| format!("{} is not a number", foton_input::quoted(word)))
    }

    fn count(&mut self) -> Result<usize, String> {
        let count = self.next()?;
        if count >= 1.0 && count <= MAX_ANGLES as f64 && count.fract() == 0.0 {
            Ok(count as usize)
        } else {
            Err(format!("{count} is not a number of angles"))
        }
    }

    fn growing(&mut self, count: usize) -> Result<Vec<f64>, String> {
        let all = (0..count).map(|_| self.next()).collect::<Result<Vec<f64>, _>>()?;
        let grows = all.windows(2).all(|pair| pair[0] < pair[1]);
        if grows { Ok(all) } else { Err("its angles do not grow".to_owned()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "IESNA:LM-63-2002\r\n[MANUFAC] nobody\r\nTILT=NONE\r\n";

    /// cos² of a quarter, by 45° about the axis brighter.
    #[test]
    fn a_lamp_is_read_between_its_angles_and_mirrored() {
        let text = format!(
            "{HEAD}1 1000 2 3 3 1 2 0 0 0\n1 0.5 60\n0 45 90\n0 45 90\n100 50 0\n100 60, 0\n100 70 0\n"
        );
        let lamp = read(text.as_bytes()).expect("it is sound");
        assert_eq!((lamp.width, lamp.height), (720, 361));
        let at = |x: usize, y: usize| lamp.pixels[y * 720 + x].g;
        assert_eq!([at(5, 0), at(400, 0)], [100.0; 2], "straight down");
        // Half a step beside C = 45°, at 45° from the axis, and mirrored about 90° and 180°.
        let near = 60.0 - 10.0 * 0.25 / 45.0;
        for x in [89, 270, 449, 630] {
            assert!((at(x, 90) - near).abs() < 1e-4, "{x}: {}", at(x, 90));
        }
        assert!((at(0, 45) - (75.0 + 5.0 * 0.25 / 45.0)).abs() < 1e-3);
        assert_eq!(at(100, 181), 0.0, "above the lamp");
        assert_eq!(lamp.pixels.len(), 720 * 361);
    }

    #[test]
    fn a_lamp_that_is_the_same_all_around_has_one_column() {
        let text = format!("{HEAD}1 -1 1 2 1 1 1 0 0 0 1 1 0\n0 180\n0\n10 30");
        let lamp = read(text.as_bytes()).expect("it is sound");
        assert_eq!(
            (lamp.width, lamp.pixels[0].r, lamp.pixels[180].r, lamp.pixels[360].r),
            (1, 10.0, 20.0, 30.0)
        );
    }

    #[test]
    fn what_is_wrong_with_a_file_is_said() {
        let said = |text: &str| read(text.as_bytes()).expect_err("it is not sound");
        assert_eq!(said("no lamp"), "it has no line \"TILT=\"");
        assert_eq!(said("TILT=lamp.tlt\n"), "its tilt is in a file of its own, which is not read");
        assert_eq!(said(&format!("{HEAD}1 2 3")), "it ends too early");
        assert_eq!(said(&format!("{HEAD}1 2 x")), "\"x\" is not a number");
        assert_eq!(said(&format!("{HEAD}1 2 1 1e9")), "1000000000 is not a number of angles");
        assert_eq!(said(&format!("{HEAD}1 2 1 2 1 2")), "it is of type B, and only type C is read");
        assert_eq!(said(&format!("{HEAD}1 2 1 2 1 1 1 0 0 0 1 1 0 90 0 0 1 1")), "its angles do not grow");
    }
}
