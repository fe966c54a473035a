//! What is read of a property file, and what is said about it.

use super::*;
use mbody::description::finding::Severity;

const FILE: &str = "$ a remark
[MDI_HEADER]
FILE_TYPE = 'tir'
! another one
[UNITS]
LENGTH = 'mm'
FORCE = 'lbf'
ANGLE = \"degrees\"
TIME = 'second'
[MODEL]
FITTYP = 52   $ 5.2
TYRESIDE = 'Right'
LONGVL = 16700
[DIMENSION]
UNLOADED_RADIUS = 3.0D2
[SHAPE]
{radial width}
 1.0 0.0
 0.9 1.0
[VERTICAL]
FNOMIN = 300
VERTICAL_STIFFNESS = 34
[INCLINATION_ANGLE_RANGE]
CAMMIN = -10
CAMMAX = 10
[LONGITUDINAL_COEFFICIENTS]
PCX1 = 1.6
PDX1 = 1.2
PKX1 = 25
[LATERAL_COEFFICIENTS]
PCY1 = 1.3
PDY1 = 1.1
PKY1 = -20
PKY2 = 1.5
";

fn read_it(text: &str) -> (Option<PropertyFile>, Findings) {
    let mut findings = Findings::new();
    let file = read("test.tir", text, FileAxes::IsoW, &mut findings);
    (file, findings)
}

fn codes(findings: &Findings) -> Vec<(&'static str, Option<usize>)> {
    findings.iter().map(|f| (f.code, f.line)).collect()
}

#[test]
fn units_sides_tables_and_remarks_are_read() {
    let (file, findings) = read_it(FILE);
    assert!(findings.is_empty(), "{findings}");
    let file = file.unwrap();
    let c = &file.coefficients;
    assert_eq!((file.dialect.name, file.side), ("MF 5.2", TireSide::Right));
    assert!((c.UNLOADED_RADIUS - 0.3).abs() < 1e-12 && (c.FNOMIN - 300.0 * 4.448_221_615_260_5).abs() < 1e-9);
    assert!((c.VERTICAL_STIFFNESS - 34.0 * 4_448.221_615_260_5).abs() < 1e-6 && (c.LONGVL - 16.7).abs() < 1e-12);
    assert!((c.CAMMAX - 10f64.to_radians()).abs() < 1e-15);
    // coefficients have no units; what is left out is neutral
    assert_eq!((c.PKY1, c.LMUX, c.PHY1), (-20.0, 1.0, 0.0));
    assert_eq!(file.scanned.tables[0].rows, [[1.0, 0.0], [0.9, 1.0]]);
}

#[test]
fn the_dialect_comes_from_format_keys_or_number() {
    let of = |from: &str, to: &str| read_it(&FILE.replace(from, to)).0.map(|f| f.dialect.name);
    assert_eq!(of("FITTYP = 52 ", "PROPERTY_FILE_FORMAT = 'PAC2002'"), Some("MF 5.2"));
    assert_eq!(of("FITTYP = 52 ", "PROPERTY_FILE_FORMAT = 'PAC-MC'\nPCY2 = 0.4\nPKY3 = 1"), Some("PAC_MC"));
    assert_eq!(of("FITTYP = 52 ", "PCY2 = 0.4\nPKY3 = 1 "), Some("PAC_MC"));
    assert_eq!(of("FITTYP = 52 ", "FITTYP = 61"), Some("MF 6.1"));
    assert_eq!(of("FITTYP = 52 ", "PKY6 = -1"), Some("MF 6.1"));
    assert_eq!(of("FITTYP = 52 ", ""), Some("MF 5.2"));
    let (file, findings) = read_it(&FILE.replace("FITTYP = 52", "FITTYP = 77"));
    assert!(file.is_none() && codes(&findings) == [("unknown_dialect", Some(11))], "{findings}");
}

#[test]
fn several_mistakes_are_told_at_once_with_their_lines() {
    let text = FILE
        .replace("'lbf'", "'stone'")
        .replace("PCX1 = 1.6", "PCXX1 = 1.6")
        .replace("PDX1 = 1.2", "PDX1 = fast?")
        .replace("PKY2 = 1.5", "PKY2 is 1.5")
        .replace("FNOMIN = 300", "LMUX = 0\nFNOMIN = 300");
    let (file, findings) = read_it(&text);
    assert!(file.is_none());
    let told: Vec<String> = findings.iter().map(|f| format!("{}:{}", f.code, f.line.unwrap_or(0))).collect();
    for expected in
        ["unknown_unit:7", "missing_key:27", "unknown_key:28", "wrong_type:29", "out_of_range:21", "tir_syntax:35", "missing_key:31"]
    {
        assert!(told.iter().any(|t| t == expected), "{expected} is not among {told:?}\n{findings}");
    }
    let hint = findings.iter().find(|f| f.code == "unknown_key").and_then(|f| f.hint.clone());
    assert_eq!(hint.as_deref(), Some("did you mean `PCX1`?"));
}

#[test]
fn suspicious_files_are_warned_of_and_read() {
    let text =
        FILE.replace("LENGTH = 'mm'", "LENGTH = 'meter'").replace("PKY2 = 1.5", "PKY2 = 1.5\nPKY2 = 1.6\nPPX1 = 2\nQDTP1 = 3\nLKYY = 1");
    let (file, findings) = read_it(&text);
    let file = file.unwrap();
    assert_eq!(file.coefficients.PKY2, 1.6);
    let told: Vec<&str> = findings.iter().map(|f| f.code).collect();
    for expected in ["suspicious_unit", "repeated_key", "other_dialect", "unknown_key"] {
        assert!(told.contains(&expected), "{expected}: {told:?}");
    }
    assert!(findings.iter().all(|f| f.severity == Severity::Warning));
    // what nobody knows is kept
    assert!(file.scanned.entries.iter().any(|e| e.key == "LKYY"));
}

#[test]
fn turn_slip_is_told_to_have_no_effect() {
    let (file, findings) = read_it(&format!("{FILE}[TURNSLIP_COEFFICIENTS]\nPDXP1 = 0.4\nPDXP2 = 0\n"));
    assert!(file.is_some() && codes(&findings) == [("turn_slip", Some(36))], "{findings}");
    assert!(findings.iter().all(|f| f.severity == Severity::Note));
}

#[test]
fn the_sign_of_the_cornering_stiffness_tells_the_axes() {
    let positive = FILE.replace("PKY1 = -20", "PKY1 = 20");
    let (file, findings) = read_it(&positive);
    assert!(file.is_none() && codes(&findings) == [("cornering_sign", Some(33))], "{findings}");
    let mut findings = Findings::new();
    assert!(read("test.tir", &positive, FileAxes::AdaptedSae, &mut findings).is_some() && findings.is_empty());
    assert!(read("test.tir", FILE, FileAxes::AdaptedSae, &mut findings).is_none());
}

#[test]
fn no_text_makes_the_reader_panic() {
    for text in ["", "[", "[]", "=", "a=", "= 1", "{", "'", "a = '", "[X]\n{a}\n1 2\nx", "a = 1e999", "ä = 'ü' $ é"] {
        let (file, findings) = read_it(text);
        assert!(file.is_none() && findings.has_errors(), "{text}");
    }
}
