//! The functions as JavaScript calls them.

use std::cell::RefCell;

use js_sys::{Error, Float32Array, Function, Reflect, Uint8Array};
use serde_json::Value;
use wasm_bindgen::prelude::*;

use crate::{Failure, cases, files, runs, surfaces};

type Outcome<T = ()> = Result<T, JsValue>;

impl From<Failure> for JsValue {
    fn from(failure: Failure) -> Self {
        let Failure { name, message, hint, key, place, available } = failure;
        let error = Error::new(&message);
        error.set_name(&name);
        let set = |property: &str, value: JsValue| _ = Reflect::set(&error, &property.into(), &value);
        let texts = [("hint", hint), ("key", key)];
        texts
            .into_iter()
            .filter_map(|(key, text)| Some((key, text?)))
            .for_each(|(key, text)| set(key, text.into()));
        for (property, number) in ["line", "column"].into_iter().zip(place.into_iter().flatten()) {
            set(property, (number as f64).into());
        }
        if let Some(names) = available {
            set("available", names.into());
        }
        error.into()
    }
}

#[wasm_bindgen]
pub fn put(name: &str, bytes: &[u8]) -> Outcome {
    Ok(files::put(name, bytes)?)
}

#[wasm_bindgen]
pub fn get(name: &str) -> Outcome<Uint8Array> {
    Ok(files::get(name)?.as_slice().into())
}

#[wasm_bindgen]
pub fn files(folder: &str) -> String {
    files::files(folder).to_string()
}

#[wasm_bindgen]
pub fn remove(name: &str) {
    files::remove(name);
}

#[wasm_bindgen]
pub fn examples() -> String {
    cases::examples().to_string()
}

#[wasm_bindgen]
pub fn example(name: &str) -> Outcome<String> {
    Ok(cases::example(name)?)
}

#[wasm_bindgen]
pub fn materials() -> String {
    cases::materials().to_string()
}

#[wasm_bindgen]
pub fn read_case(text: &str) -> Outcome<String> {
    Ok(cases::read_case(text)?.to_string())
}

#[wasm_bindgen]
pub fn write_case(tables: &str) -> Outcome<String> {
    Ok(cases::write_case(tables)?)
}

#[wasm_bindgen]
pub fn commands(case: &str) -> String {
    cases::commands(case).to_string()
}

#[wasm_bindgen]
pub fn scan(name: &str, reading: &str) -> Outcome<String> {
    Ok(surfaces::scan(name, reading)?.to_string())
}

#[wasm_bindgen]
pub struct Surface(surfaces::Surface);

#[wasm_bindgen]
impl Surface {
    #[wasm_bindgen(constructor)]
    pub fn new(table: &str) -> Outcome<Self> {
        Ok(Self(surfaces::Surface::new(table)?))
    }

    pub fn about(&self) -> Outcome<String> {
        Ok(self.0.about()?.to_string())
    }

    pub fn map(&self) -> String {
        self.0.map().to_string()
    }

    pub fn heights(&self) -> Float32Array {
        self.0.heights().as_slice().into()
    }

    pub fn write(&self, name: &str) -> Outcome {
        Ok(self.0.write(name)?)
    }
}

#[wasm_bindgen]
pub fn colours() -> String {
    asperity_report::page::colours().to_string()
}

#[wasm_bindgen]
pub fn check(case: &str) -> Outcome<String> {
    Ok(runs::check(case)?.to_string())
}

thread_local! {
    /// The function that gets the events of the present run.
    static LISTENER: RefCell<Option<Function>> = const { RefCell::new(None) };
}

/// Passes an event on, and returns whether it asks to stop. The function may call any other of this module.
fn tell(event: &Value) -> bool {
    let listener = LISTENER.with_borrow(Clone::clone);
    let answer = listener.map(|listener| listener.call1(&JsValue::NULL, &event.to_string().into()));
    answer.is_some_and(|answer| answer.is_ok_and(|answer| answer.is_truthy()))
}

#[wasm_bindgen]
pub fn run(case: &str, folder: &str, existing: &str, watch: Function) -> Outcome<String> {
    LISTENER.set(Some(watch));
    let summary = runs::run(case, folder, existing, tell);
    LISTENER.set(None);
    Ok(summary?.to_string())
}

#[wasm_bindgen]
pub fn report(folder: &str) -> Outcome {
    Ok(runs::report(folder)?)
}

#[wasm_bindgen]
pub fn figures(folder: &str) -> Outcome<String> {
    Ok(runs::figures(folder)?.to_string())
}

#[wasm_bindgen]
pub fn figure(folder: &str, name: &str, format: &str) -> Outcome<Uint8Array> {
    Ok(runs::figure(folder, name, format)?.as_slice().into())
}

#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
