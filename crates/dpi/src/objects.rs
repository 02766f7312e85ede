//! Objects behind handles, and the errors of each.

use std::collections::BTreeMap;
use std::ffi::CString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

use crate::checker::Checker;
use crate::photons::Source;

/// Largest number of errors that a handle keeps.
const MOST_ERRORS: usize = 1000;

/// Objects, by handle; 0 has the errors of objects that could not be created.
static OBJECTS: Mutex<Objects> = Mutex::new(Objects { last: 0, by_handle: BTreeMap::new() });

struct Objects {
    last: usize,
    by_handle: BTreeMap<usize, Object>,
}

/// An object behind a handle.
#[derive(Default)]
pub struct Object {
    pub errors: Vec<CString>,
    pub kind: ObjectKind,
}

#[derive(Default)]
pub enum ObjectKind {
    /// No object, only errors.
    #[default]
    Nothing,
    Checker(Box<Checker>),
    Photons(Box<Source>),
}

impl Object {
    /// Records an error, if there are not too many. Zeros in its text, which would end a C string, are replaced.
    pub fn record(&mut self, error: impl ToString) {
        let text = match self.errors.len() {
            0..MOST_ERRORS => error.to_string().replace('\0', " "),
            MOST_ERRORS => {
                format!("there are more than {MOST_ERRORS} errors: call tofsim_clear_errors")
            }
            _ => return,
        };
        self.errors.extend(CString::new(text));
    }

    pub fn checker(&mut self) -> Result<&mut Checker, String> {
        match &mut self.kind {
            ObjectKind::Checker(checker) => Ok(checker),
            _ => Err("this handle is of no block".to_owned()),
        }
    }

    pub fn photons(&mut self) -> Result<&mut Source, String> {
        match &mut self.kind {
            ObjectKind::Photons(source) => Ok(source),
            _ => Err("this handle is of no photons".to_owned()),
        }
    }
}

/// Creates an object, and returns its handle, or 0.
pub fn make(function: &str, run: impl FnOnce() -> Result<ObjectKind, String>) -> usize {
    let made = guarded(run);
    let mut objects = OBJECTS.lock().unwrap_or_else(PoisonError::into_inner);
    match made {
        Ok(kind) => {
            objects.last += 1;
            let handle = objects.last;
            objects.by_handle.insert(handle, Object { kind, ..Object::default() });
            handle
        }
        Err(error) => {
            objects.by_handle.entry(0).or_default().record(format_args!("{function}: {error}"));
            0
        }
    }
}

/// Calls a function with the object behind a handle. If it fails, the error is recorded and `otherwise` is returned.
pub fn with<T>(
    function: &str,
    handle: usize,
    otherwise: T,
    run: impl FnOnce(&mut Object) -> Result<T, String>,
) -> T {
    let mut objects = OBJECTS.lock().unwrap_or_else(PoisonError::into_inner);
    let objects = &mut *objects;
    let known = handle != 0 && objects.by_handle.contains_key(&handle);
    let object = objects.by_handle.entry(if known { handle } else { 0 }).or_default();
    if !known {
        object.record(match handle {
            0 => format!(
                "{function}: the handle is null: nothing was made, and what that said is above"
            ),
            _ => format!("{function}: no such handle: it was never given, or deleted"),
        });
        return otherwise;
    }
    guarded(|| run(object)).unwrap_or_else(|error| {
        object.record(format_args!("{function}: {error}"));
        otherwise
    })
}

/// Calls a function with the errors of a handle, or of null.
pub fn errors<T>(handle: usize, run: impl FnOnce(&mut Vec<CString>) -> T) -> T {
    let mut objects = OBJECTS.lock().unwrap_or_else(PoisonError::into_inner);
    let known = objects.by_handle.contains_key(&handle);
    let object = objects.by_handle.entry(if known { handle } else { 0 }).or_default();
    run(&mut object.errors)
}

/// Returns how often the checkers of a block have compared its outputs so far, all together.
pub fn compared(block: &str) -> u64 {
    let objects = OBJECTS.lock().unwrap_or_else(PoisonError::into_inner);
    let of_block = |object: &Object| match &object.kind {
        ObjectKind::Checker(checker) if checker.block.name() == block => checker.compared,
        _ => 0,
    };
    objects.by_handle.values().map(of_block).sum()
}

/// Deletes the object behind a handle.
pub fn delete(handle: usize) {
    let mut objects = OBJECTS.lock().unwrap_or_else(PoisonError::into_inner);
    objects.by_handle.remove(&handle);
}

/// Converts a panic to an error.
fn guarded<T>(run: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        Err(format!("a fault of tofsim: {}", text.unwrap_or_default()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error() {
        let handle = make("tofsim_new", || Ok(ObjectKind::Nothing));
        let got = with("tofsim_step", handle, -1, |_| panic!("out of range"));
        let said = errors(handle, |errors| errors[0].to_str().unwrap().to_owned());
        assert_eq!((got, said.as_str()), (-1, "tofsim_step: a fault of tofsim: out of range"));
        delete(handle);
        assert_eq!(with("tofsim_step", handle, -1, |_| Ok(1)), -1);
        let said = errors(0, |errors| errors.pop().unwrap().into_string().unwrap());
        assert_eq!(said, "tofsim_step: no such handle: it was never given, or deleted");
    }
}
