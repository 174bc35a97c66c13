//! The report as JSON, as the library serialises it, with the readers' warnings and the input files.

use serde_json::{Value, json};

use super::checked::Checked;

/// Numbers that are not finite become null.
pub fn json(checked: &Checked) -> String {
    let mut report = serde_json::to_value(&checked.report).unwrap_or_default();
    if let Value::Object(members) = &mut report {
        let said = [
            ("verdict", json!(checked.verdict)),
            ("code", json!(checked.code)),
            ("reason", json!(checked.reason)),
            ("warnings", checked.warnings.iter().map(|warning| warning.json.clone()).collect()),
            ("inputs", json!(checked.inputs)),
        ];
        members.extend(said.map(|(name, value)| (name.to_owned(), value)));
    }
    format!("{report:#}\n")
}
