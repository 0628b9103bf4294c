//! Conductors by the names that scene files give them.

use foton_input::quoted;
use foton_math::Rgb;
use foton_scene::metals::METALS;

use crate::spelling::did_you_mean;

/// The indices eta and k of a conductor; otherwise why there are none.
pub(crate) fn find(name: &str) -> Result<(Rgb, Rgb), String> {
    // Names with the suffix of a data base mean the same measurement where there is only one.
    let found = |wanted: &str| METALS.iter().find(|(known, ..)| *known == wanted);
    match found(name).or_else(|| found(name.strip_suffix("_palik")?)) {
        Some((_, eta, k)) => Ok((Rgb::from_array(*eta), Rgb::from_array(*k))),
        None => {
            let names = METALS.iter().map(|(known, ..)| *known).chain(["none"]);
            Err(format!("no conductor called {} is known{}", quoted(name), did_you_mean(name, names)))
        }
    }
}
