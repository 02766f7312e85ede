//! Columns of a plan's table.

use crate::plan::Plan;
use crate::plan::axis::Axis;
use crate::plan::file::Refused;
use crate::table::{Field, Kind};

/// Returns the columns of a plan's table.
pub fn header(plan: &Plan) -> Vec<Field> {
    let axis = |axis: &Axis| {
        let kind = if axis.is_text { Kind::Text } else { Kind::Number };
        Field::new(&axis.key, kind)
    };
    let mut fields = vec![Field::new("point", Kind::Whole)];
    fields.extend(plan.points.axes.iter().map(axis));
    fields.push(Field::new("seed", Kind::Whole));
    if let Some(search) = &plan.search {
        fields.push(Field::new(&search.key, Kind::Number));
        fields.push(Field::new(&format!("{}_se", search.key), Kind::Number));
        fields.push(Field::new("search", Kind::Text));
        fields.push(Field::new("found_repeats", Kind::Whole));
        fields.extend(search.over.iter().map(axis));
    }
    for column in &plan.outputs {
        fields.push(Field::new(&column.name, Kind::Number));
        if column.is_random() {
            fields.push(Field::new(&format!("{}_se", column.name), Kind::Number));
        }
    }
    fields.push(Field::new("notes", Kind::Text));
    if plan.file.refused == Refused::Keep {
        fields.push(Field::new("refused", Kind::Text));
    }
    fields
}
