//! Why figures or a page could not be made.

use std::fmt;

use crate::draw;

/// A failure to draw the results.
#[derive(Debug)]
pub enum Error {
    /// The results could not be read, or a file not be written.
    Results(asperity_base::Error),
    /// A figure that could not be drawn.
    Figure(draw::Error),
    /// The results do not have what was asked for.
    Missing {
        /// The thing that the results lack.
        message: String,
        /// Advice: something to ask for instead.
        hint: Option<String>,
    },
}

/// The result of drawing.
pub type Result<T = ()> = std::result::Result<T, Error>;

impl Error {
    pub(crate) fn missing(message: impl Into<String>, hint: Option<&str>) -> Self {
        Self::Missing { message: message.into(), hint: hint.map(str::to_owned) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Results(asperity_base::Error::Case(case)) => f.write_str(&case.message),
            Self::Results(error) => error.fmt(f),
            Self::Figure(error) => error.fmt(f),
            Self::Missing { message, .. } => f.write_str(message),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Results(error) => Some(error),
            Self::Figure(error) => Some(error),
            Self::Missing { .. } => None,
        }
    }
}

impl From<asperity_base::Error> for Error {
    fn from(error: asperity_base::Error) -> Self {
        Self::Results(error)
    }
}

impl From<draw::Error> for Error {
    fn from(error: draw::Error) -> Self {
        Self::Figure(error)
    }
}
