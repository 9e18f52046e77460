//! Every figure lies in its range.

use super::*;

#[test]
fn every_figure_lies_in_its_range() {
    let report = Report::of_all(|_| {});
    println!("{report}");
    assert_eq!(report.failures(), Vec::<String>::new());
}

/// A figure that fails shows it: in the cell, and among the failures.
#[test]
fn a_report_says_what_passes_and_what_fails() {
    let figures = vec![
        Figure::between("time", 20.5, "ms", 19.0, 24.0),
        Figure::at_most("error", 2e-5, "m", 1e-9),
        Figure::at_least("window", f64::NAN, "ms", 2.0),
        Figure::told("place", 3.0, "mm"),
    ];
    let report = Report { rows: vec![Row { name: "drill", drill: "It is done.", figures }] };
    let expected = "| what | figure | pass | measured | |
|---|---|---|---|---|
| drill | time | 19 to 24 ms | 20.50 ms | passes |
|  | error | at most 1.0e-9 m | 2.0e-5 m | **fails** |
|  | window | at least 2 ms | never | **fails** |
|  | place |  | 3 mm | |

The drills:

- drill: It is done.
";
    assert_eq!(report.to_string(), expected);
    assert_eq!(report.failures(), ["drill, error: 0.00002 m", "drill, window: NaN ms"]);
}
