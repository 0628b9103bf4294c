//! Where the sun stands at a place and a time: the algorithm of Blanco-Muriel and others `[BMLM01]`.

use foton_math::glam::DVec3;

/// A place on earth and a time there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaceAndTime {
    /// Degrees to the north.
    pub(crate) latitude: f64,
    /// Degrees to the east.
    pub(crate) longitude: f64,
    /// Hours that the clock is ahead of Greenwich.
    pub(crate) timezone: f64,
    /// Year, month and day.
    pub(crate) date: [f64; 3],
    /// Hour, minute and second.
    pub(crate) time: [f64; 3],
}

impl PlaceAndTime {
    /// The unit direction of the sun: +x is east, +y up, +z south. Below the horizon y is negative.
    pub(crate) fn sun(&self) -> DVec3 {
        let [year, month, day] = self.date;
        let [hour, minute, second] = self.time;
        let hours = hour - self.timezone + (minute + second / 60.0) / 60.0;
        // Divisions of whole numbers.
        let late = ((month - 14.0) / 12.0).trunc();
        let julian_day = (1461.0 * (year + 4800.0 + late) / 4.0).trunc()
            + (367.0 * (month - 2.0 - 12.0 * late) / 12.0).trunc()
            - (3.0 * ((year + 4900.0 + late) / 100.0).trunc() / 4.0).trunc()
            + day
            - 32_075.0;
        let n = julian_day - 0.5 + hours / 24.0 - 2_451_545.0;
        let omega = 2.1429 - 0.001_039_459_4 * n;
        let (mean_longitude, anomaly) = (4.895_063 + 0.017_202_791_698 * n, 6.240_06 + 0.017_201_969_9 * n);
        let longitude = mean_longitude + 0.033_416_07 * anomaly.sin() + 0.000_348_94 * (2.0 * anomaly).sin()
            - 0.000_113_4
            - 0.000_020_3 * omega.sin();
        let obliquity = 0.409_092_8 - 6.2140e-9 * n + 0.000_039_6 * omega.cos();
        let ascension = (obliquity.cos() * longitude.sin()).atan2(longitude.cos());
        let declination = (obliquity.sin() * longitude.sin()).asin();
        let sidereal = 6.697_424_324_2 + 0.065_709_828_3 * n + hours;
        let hour_angle = (sidereal * 15.0 + self.longitude).to_radians() - ascension;
        let latitude = self.latitude.to_radians();
        let zenith = (latitude.cos() * hour_angle.cos() * declination.cos()
            + declination.sin() * latitude.sin())
        .acos();
        let azimuth =
            (-hour_angle.sin()).atan2(declination.tan() * latitude.cos() - latitude.sin() * hour_angle.cos());
        // The parallax: the earth's radius by the distance of the sun.
        let zenith = zenith + 6371.01 / 149_597_890.0 * zenith.sin();
        DVec3::new(azimuth.sin() * zenith.sin(), zenith.cos(), -azimuth.cos() * zenith.sin())
    }
}
