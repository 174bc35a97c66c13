//! The table of codes has a row for each code that the crate can give.

use std::collections::BTreeSet;

use bimodal_stereo::{CODES, CheckReason, ErrorKind, Reason, WarningKind};
use serde_json::Value;

fn rows(group: &str) -> BTreeSet<String> {
    let table: Value = serde_json::from_str(CODES).unwrap();
    let rows = table[group].as_object().unwrap_or_else(|| panic!("no {group}"));
    let is_told =
        |row: &Value| ["cause", "remedy"].iter().all(|part| row[part].as_str().is_some_and(|words| words.len() > 10));
    assert!(rows.values().all(is_told), "a row of {group} lacks its cause or its remedy");
    rows.keys().cloned().collect()
}

fn names(codes: &[&str]) -> BTreeSet<String> {
    codes.iter().map(|code| (*code).to_owned()).collect()
}

#[test]
fn every_code_has_a_row_and_every_row_a_code() {
    assert_eq!(rows("runs"), names(Reason::CODES));
    assert_eq!(rows("checks"), names(CheckReason::CODES));
    assert_eq!(rows("warnings"), names(WarningKind::CODES));
    // The packages refuse further inputs before the crate sees them.
    assert!(rows("errors").is_superset(&names(ErrorKind::CODES)));
}
