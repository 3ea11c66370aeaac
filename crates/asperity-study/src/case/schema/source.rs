//! Case files as the source of tables whose struct declares the keys.

use super::super::cursor::{Entry, Table};
use super::numbers::{count, real};
use super::tables::{GIVEN, known_in, suits};
use super::{Key, Kind, sweep};
use asperity_base::error::{Error, Result};
use asperity_base::table::{self, Source, Spacing, expected};
use asperity_base::units::Dimension;

impl Source for Table<'_> {
    fn value(&self, key: &str) -> Option<Box<dyn table::Value + '_>> {
        self.get(key).map(|entry| Box::new(entry) as Box<dyn table::Value>)
    }

    fn missing(&self, key: &Key) -> Error {
        match key.kind {
            Kind::Table => self.missing_table(key.name),
            _ => {
                let hint = format!("for example `{} = {}`", key.name, key.example);
                self.error(format!("missing key '{}' in {}", key.name, self.name()), Some(hint))
            }
        }
    }

    fn exactly_one(&self, keys: &[&'static str], hint: &str) -> Result<&'static str> {
        // Only a program that calls the library can supply arrays, so messages do not mention it otherwise.
        let keys: Vec<_> =
            keys.iter().copied().filter(|key| *key != GIVEN || self.get(key).is_some()).collect();
        self.exactly_one(&keys, hint)
    }

    fn suits(&self, choice: &str) -> Result<()> {
        suits(self, choice)
    }
}

impl table::Value for Entry<'_> {
    fn real(&self, key: &Key, kind: &Kind) -> Result<f64> {
        real(kind, key, self)
    }

    fn count(&self, key: &Key, kind: &Kind) -> Result<usize> {
        count(kind, key, self)
    }

    fn whole(&self, least: u64) -> Result<u64> {
        self.whole(least)
    }

    fn flag(&self) -> Result<bool> {
        self.flag()
    }

    fn word(&self, words: &[&'static str], hint: &dyn Fn(&str) -> Option<String>) -> Result<usize> {
        self.word(words, hint)
    }

    fn text(&self) -> Result<&str> {
        self.text()
    }

    fn pair(&self, key: &Key) -> Result<[f64; 2]> {
        match key.kind {
            Kind::Pair(item) => {
                self.pair(&format!("{}, or two", expected(item, key)), |part| real(item, key, part))
            }
            Kind::Vector(item) => {
                let noun = item.dimension().map_or("a number", Dimension::noun);
                self.vector(&format!("{noun} along x, or two along x and y"), |part| real(item, key, part))
            }
            _ => unreachable!("two numbers are declared as such"),
        }
    }

    fn unit(&self, dimension: Dimension) -> Result<f64> {
        self.unit(dimension)
    }

    fn is_array(&self) -> bool {
        self.is_array()
    }

    fn is_table(&self) -> bool {
        self.is_table()
    }

    fn table(&self) -> Result<Box<dyn Source + '_>> {
        let table = self.clone().table()?;
        known_in(&table)?;
        Ok(Box::new(table))
    }

    fn tables(&self) -> Result<Vec<Box<dyn Source + '_>>> {
        let mut tables = Vec::new();
        for table in self.tables()? {
            known_in(&table)?;
            tables.push(Box::new(table) as Box<dyn Source>);
        }
        Ok(tables)
    }

    fn items(&self, expected: &str) -> Result<Vec<Box<dyn table::Value + '_>>> {
        Ok(self.items(expected)?.into_iter().map(|item| Box::new(item) as Box<dyn table::Value>).collect())
    }

    fn several(&self, key: &Key, kind: &Kind, spacing: Spacing, example: &str) -> Result<Vec<[f64; 2]>> {
        sweep::several(self, key, kind, spacing, example)
    }

    fn unexpected(&self, expected: &str, hint: Option<&str>) -> Error {
        self.unexpected(expected, hint.map(str::to_owned))
    }

    fn error(&self, message: &str, hint: Option<&str>) -> Error {
        self.error(message.to_owned(), hint.map(str::to_owned))
    }
}
