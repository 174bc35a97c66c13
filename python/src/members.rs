//! The members of a dictionary, with the names and types of the contract.

use std::fmt::Display;

use numpy::{Element, PyReadonlyArrayDyn};
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::failure;

/// A dictionary and its path in the contract. A member that is `None` counts as absent.
pub struct Members<'py> {
    own: Bound<'py, PyDict>,
    path: String,
}

impl<'py> Members<'py> {
    /// Refuses all names but these. The path of arguments is empty.
    pub fn new(value: &Bound<'py, PyAny>, path: &str, names: &[&str]) -> PyResult<Self> {
        let own = value.cast::<PyDict>().map_err(|_| wrong(path, "a dictionary or the object made for it", value))?;
        let members = Self { own: own.clone(), path: path.to_owned() };
        for (key, _) in own {
            let name = key.extract::<String>().map_err(|_| wrong(path, "a dictionary with names", value))?;
            if !names.contains(&name.as_str()) {
                let known = names.join(", ");
                return Err(failure("option", &members.at(&name), &format!("is an unknown name; known: {known}")));
            }
        }
        Ok(members)
    }

    /// The path of a member.
    pub fn at(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    pub fn get(&self, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(self.own.get_item(name)?.filter(|value| !value.is_none()))
    }

    /// A required member.
    pub fn needed<T>(&self, name: &str, value: Option<T>) -> PyResult<T> {
        value.ok_or_else(|| failure("missing", &self.at(name), "is required"))
    }

    fn typed<T: for<'a> FromPyObject<'a, 'py, Error = PyErr>>(&self, name: &str, what: &str) -> PyResult<Option<T>> {
        let Some(value) = self.get(name)? else { return Ok(None) };
        let py = value.py();
        let refused = |error: PyErr| match error.is_instance_of::<PyOverflowError>(py) {
            true => failure("range", &self.at(name), &format!("must be {what}, not {value}")),
            false => wrong(&self.at(name), what, &value),
        };
        value.extract().map(Some).map_err(refused)
    }

    pub fn number(&self, name: &str) -> PyResult<Option<f64>> {
        self.typed(name, "a number")
    }

    pub fn whole<T: for<'a> FromPyObject<'a, 'py, Error = PyErr>>(&self, name: &str) -> PyResult<Option<T>> {
        self.typed(name, "a whole number, zero or above")
    }

    pub fn flag(&self, name: &str) -> PyResult<Option<bool>> {
        self.typed(name, "True or False")
    }

    pub fn text(&self, name: &str) -> PyResult<Option<String>> {
        self.typed(name, "a string")
    }

    /// The value for which one of some words stands.
    pub fn word<T: Copy>(&self, name: &str, words: &[(&str, T)]) -> PyResult<Option<T>> {
        let Some(given) = self.text(name)? else { return Ok(None) };
        let found = words.iter().find(|(word, _)| *word == given).map(|&(_, value)| value);
        found.map(Some).ok_or_else(|| unknown(&self.at(name), &given, words.iter().map(|(word, _)| word)))
    }

    /// A list of numbers, or an array of any shape.
    pub fn list(&self, name: &str) -> PyResult<Option<Vec<f64>>> {
        let Some(value) = self.get(name)? else { return Ok(None) };
        let flat = value.call_method0("ravel").unwrap_or(value);
        flat.extract().map(Some).map_err(|_| wrong(&self.at(name), "a list of numbers", &flat))
    }

    /// A list of this many numbers.
    pub fn numbers<const COUNT: usize>(&self, name: &str) -> PyResult<Option<[f64; COUNT]>> {
        let Some(list) = self.list(name)? else { return Ok(None) };
        let message = format!("needs {COUNT} numbers, not {}", list.len());
        list.try_into().map(Some).map_err(|_| failure("size", &self.at(name), &message))
    }

    /// The numbers of an array that the package has made contiguous.
    pub fn array<T: Element + Copy>(&self, name: &str) -> PyResult<Option<Vec<T>>> {
        let Some(value) = self.get(name)? else { return Ok(None) };
        Ok(value.extract::<PyReadonlyArrayDyn<'py, T>>().ok().and_then(|array| Some(array.as_slice().ok()?.to_vec())))
    }

    /// A dictionary among the members.
    pub fn below(&self, name: &str, names: &[&str]) -> PyResult<Option<Self>> {
        self.get(name)?.map(|value| Self::new(&value, &self.at(name), names)).transpose()
    }
}

/// The error for a value of the wrong type.
pub fn wrong(field: &str, what: &str, value: &Bound<'_, PyAny>) -> PyErr {
    let name = value.get_type().name().map_or_else(|_| "that".to_owned(), |name| name.to_string());
    failure("type", field, &format!("must be {what}, not {name}"))
}

/// The error for an unknown word.
pub fn unknown(field: &str, given: &str, known: impl Iterator<Item = impl Display>) -> PyErr {
    let known: Vec<String> = known.map(|word| word.to_string()).collect();
    failure("option", field, &format!("\"{given}\" is unknown; known: {}", known.join(", ")))
}
