//! Failures as a page reports them.

use asperity_base::Error;
use asperity_base::error::{CaseError, Detail};

/// A failure with all that helps to act on it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Name of the cause.
    pub name: String,
    /// A sentence.
    pub message: String,
    /// Advice.
    pub hint: Option<String>,
    /// Key of the case file.
    pub key: Option<String>,
    /// Line and column in the case file, from 1.
    pub place: Option<[usize; 2]>,
    /// Channels of the file.
    pub available: Option<Vec<String>>,
}

/// Result of a function of a page.
pub type Result<T = ()> = std::result::Result<T, Failure>;

impl Failure {
    /// Creates a failure of input that is no case file.
    pub(crate) fn input(message: impl Into<String>) -> Self {
        let (name, message) = ("Input".to_owned(), message.into());
        Self { name, message, hint: None, key: None, place: None, available: None }
    }

    /// Creates the failure of a text that is not TOML, with its place.
    pub(crate) fn of_toml(text: &str, error: &toml::de::Error) -> Self {
        let place = error.span().and_then(|span| text.get(..span.start)).map(|before| {
            let line = before.rsplit('\n').next().unwrap_or_default();
            [1 + before.matches('\n').count(), 1 + line.chars().count()]
        });
        Self { place, ..Self::input(error.message()) }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let name = error.name().to_owned();
        if let Error::Case(case) = error {
            let CaseError { key, message, hint, line, column, .. } = *case;
            let key = Some(key).filter(|key| !key.is_empty());
            return Self { name, message, hint, key, place: Some([line, column]), available: None };
        }
        let available = error.details().into_iter().find_map(|(field, detail)| match detail {
            Detail::Texts(names) if field == "available" => Some(names.to_vec()),
            _ => None,
        });
        let (message, hint) = (error.to_string(), error.hint());
        Self { name, message, hint, key: None, place: None, available }
    }
}

impl From<asperity_report::Error> for Failure {
    fn from(error: asperity_report::Error) -> Self {
        match error {
            asperity_report::Error::Results(error) => error.into(),
            asperity_report::Error::Missing { message, hint } => Self { hint, ..Self::input(message) },
            asperity_report::Error::Figure(error) => Self::input(error.to_string()),
        }
    }
}
