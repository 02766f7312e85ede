//! Variables of a waveform's hierarchy, with their scopes.

use std::sync::Arc;

use wellen::{Hierarchy, ItemRef, Var};

/// A scope whose items are being listed.
struct Level<'a> {
    items: Box<dyn Iterator<Item = ItemRef> + 'a>,
    /// Its name and those of the scopes around it, once a variable needs them.
    names: Option<Arc<[String]>>,
}

/// Lists the variables in the hierarchy's order, with the names of their scopes, outermost first.
pub(super) fn variables(hierarchy: &Hierarchy) -> Vec<(&Var, Arc<[String]>)> {
    let (mut found, mut path) = (Vec::new(), Vec::<&str>::new());
    let mut levels = vec![Level { items: Box::new(hierarchy.items()), names: None }];
    while let Some(level) = levels.last_mut() {
        match level.items.next() {
            Some(ItemRef::Var(var)) => {
                let names = || path.iter().map(|&name| name.to_owned()).collect();
                let names = level.names.get_or_insert_with(names);
                found.push((&hierarchy[var], Arc::clone(names)));
            }
            Some(ItemRef::Scope(scope)) => {
                let scope = &hierarchy[scope];
                path.push(scope.name(hierarchy));
                levels.push(Level { items: Box::new(scope.items(hierarchy)), names: None });
            }
            None => {
                levels.pop();
                path.pop();
            }
        }
    }
    found
}

/// Returns the scopes and the own name of a variable. The library makes scopes of the indices of arrays, which are
/// part of the name.
pub(super) fn joined(scopes: Arc<[String]>, name: &str) -> (Arc<[String]>, String) {
    let is_index = |name: &String| name.starts_with('[');
    let mut own = name.to_owned();
    let mut outer = scopes.len();
    while is_index(&own) && outer > 0 {
        outer -= 1;
        own.insert_str(0, &scopes[outer]);
    }
    (if outer == scopes.len() { scopes } else { scopes[..outer].into() }, own)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_part_of_the_name() {
        let scopes: Arc<[String]> = ["top", "mem", "[1]"].map(str::to_owned).into();
        let (outer, own) = joined(Arc::clone(&scopes), "[0]");
        assert_eq!((&outer[..], own.as_str()), (&["top".to_owned()][..], "mem[1][0]"));
        let (outer, own) = joined(Arc::clone(&scopes[..1].into()), "a.b");
        assert_eq!((outer.len(), own.as_str()), (1, "a.b"));
    }
}
