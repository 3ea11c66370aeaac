//! The steps that prepare a topography.

use asperity::surface::{Axis, Fill, Filter, Interpolation, Level, Preparation, Resample};
use clap::Args;

use super::values::{angle, choice, default, factor, positive_length, resample, window};

/// Steps of the preparation, in this order.
#[derive(Debug, Args)]
#[command(next_help_heading = "Preparation, in this order")]
pub(crate) struct PreparationArguments {
    /// Part to keep, in samples
    #[arg(long, value_name = "X0,Y0,NX,NY", value_parser = window)]
    window: Option<[usize; 4]>,
    /// Turn spikes and pits into missing samples: samples, in groups of up to about 5 × 5, that deviate from
    /// their surroundings by more than this number of (robust) standard deviations, such as 6
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    despike: Option<f64>,
    /// Treatment of missing samples
    #[arg(long, default_value = default::<Fill>(), value_parser = choice::<Fill>())]
    fill: Fill,
    /// Form to subtract, fitted by least squares: none, mean, plane, quadratic, polynomial-3 (any order up to
    /// 16), sphere, cylinder
    #[arg(long, default_value = "none")]
    level: Level,
    /// Direction to reverse
    #[arg(long, value_parser = choice::<Axis>())]
    mirror: Option<Axis>,
    /// Angle of rotation, from x towards y: 90deg. Angles other than quarter turns interpolate by a spline on
    /// the largest inscribed rectangle
    #[arg(long, value_name = "ANGLE", default_value = "0", value_parser = angle, allow_hyphen_values = true)]
    rotate: f64,
    /// Nesting index of the S-filter, which removes shorter waves: 2.5um
    #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
    s_filter: Option<f64>,
    /// Nesting index of the L-filter, which removes longer waves: 0.8mm
    #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
    l_filter: Option<f64>,
    /// Kind of both filters: ISO 16610-61, or robust against scratches and peaks (after ISO 16610-71)
    #[arg(long, default_value = default::<Filter>(), value_parser = choice::<Filter>())]
    filter: Filter,
    /// Cells after resampling: their number, 256x256, or their size, 0.5um
    #[arg(long, value_name = "NXxNY|LENGTH[,LENGTH]", value_parser = resample)]
    resample: Option<Resample>,
    /// Interpolation between samples on finer grids
    #[arg(long, default_value = default::<Interpolation>(), value_parser = choice::<Interpolation>())]
    interpolate: Interpolation,
    /// Width of the rim that tapers to the mean height
    #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
    taper: Option<f64>,
}

impl PreparationArguments {
    /// Returns the preparation as a type of the library.
    pub(crate) fn preparation(&self) -> Preparation {
        Preparation {
            window: self.window,
            despike: self.despike,
            fill: self.fill,
            level: self.level,
            mirror: self.mirror,
            rotate: self.rotate,
            s_filter: self.s_filter,
            l_filter: self.l_filter,
            filter: self.filter,
            resample: self.resample,
            interpolate: self.interpolate,
            taper: self.taper,
        }
    }

    /// Returns the first argument that requires a pitch.
    pub(crate) fn needs_pitch(&self) -> Option<&'static str> {
        let lengths = [
            ("--level sphere", self.level == Level::Sphere),
            ("--level cylinder", self.level == Level::Cylinder),
            ("--s-filter", self.s_filter.is_some()),
            ("--l-filter", self.l_filter.is_some()),
            ("--resample by a length", matches!(self.resample, Some(Resample::Pitch(_)))),
            ("--taper", self.taper.is_some()),
        ];
        lengths.into_iter().find(|(_, given)| *given).map(|(name, _)| name)
    }
}
