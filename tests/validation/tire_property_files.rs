//! Tire property files against other programs: MF 6.1 and MF 5.2 point by point; PAC_MC against the motorcycle formula where both are the same.

use mbody::description::finding::Findings;
use motorcycle::tire::magic_formula::{BeyondFit, FileAxes, MagicFormula, Side, TrailCamber, Usage};
use motorcycle::tire::magic_formula_motorcycle::{CamberPeak, MagicFormulaMotorcycleParameters};
use motorcycle::tire::tir::{self, PropertyFile};
use motorcycle::tire::{Friction, Slip, TireLaw};
use serde::Deserialize;
use validation::agreement::{Agreement, Tolerance, absolute};
use validation::evidence::Row;
use validation::reference::{repository_text, text};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    mf61_example => (
        "tire property files, MF 6.1: forces and aligning moment of a car tire at 112 points of slip, slip angle, camber and load",
        "an independent transcription of the published equations in Python; `tests/reference/tire/mf61_example.csv`",
        "1e-9 of the values, or 1e-9 N and N m: printed digits"
    ),
    mf52_example => (
        "tire property files, MF 5.2: forces, three moments and relaxation lengths of a car tire at 144 points",
        "OpenTire, PAC2002, commit 6652c49; `tests/reference/tire/mf52_example.csv`",
        "1e-10 of the values: twelve printed digits"
    ),
    pac_mc_is_the_motorcycle_formula => (
        "tire property files, PAC_MC: forces at combined slip and the aligning moment are those of the motorcycle Magic Formula, which two programs hold",
        "identity of the formulas, with the coefficients of `models/tires/sel04_120_70.yaml`",
        "1e-10 of the values: rounding"
    ),
];

fn read(name: &str, text: &str, axes: FileAxes) -> PropertyFile {
    let mut findings = Findings::new();
    tir::read(name, text, axes, &mut findings).unwrap_or_else(|| panic!("{findings}"))
}

fn law(file: &PropertyFile, usage: Usage) -> MagicFormula {
    MagicFormula::new(file.coefficients, file.dialect, usage)
}

/// The formula itself, in the axes of the file.
const PLAIN: Usage = Usage {
    side: Side::Measured,
    axes: FileAxes::IsoW,
    beyond: BeyondFit::Hold,
    pressure: None,
    camber_peak: CamberPeak::Divide,
    trail_camber: TrailCamber::Magnitude,
    crowned: false,
};

fn rows(table: &str) -> Vec<Vec<f64>> {
    let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect()
}

/// Forces at a load, longitudinal slip, slip angle and camber of the file.
fn at(law: &MagicFormula, [load, longitudinal, alpha, camber, speed]: [f64; 5]) -> Friction<f64> {
    law.friction(&Slip { load, lateral: -alpha.tan(), longitudinal, camber, speed })
}

/// A tolerance relative to a value, no smaller than `least` of it.
fn relative(share: f64, value: f64, least: f64) -> Tolerance {
    absolute(share * value.abs().max(least)).because("printed digits")
}

#[test]
fn mf61_example() {
    let file = read("mf61_example.tir", &text("tire/mf61_example.tir"), FileAxes::IsoW);
    assert_eq!(file.dialect.name, "MF 6.1");
    let law = law(&file, PLAIN);
    let mut agreement = Agreement::on("MF 6.1");
    let rows = rows(&text("tire/mf61_example.csv"));
    assert_eq!(rows.len(), 112);
    for row in rows {
        let [load, kappa, alpha, camber, fx, fy, mz]: [f64; 7] = row.try_into().expect("seven columns");
        let f = at(&law, [load, kappa, alpha, camber, 16.6]);
        for (what, value, expected) in [("Fx", f.longitudinal, fx), ("Fy", f.lateral, fy), ("Mz", f.aligning_moment, mz)] {
            let what = format!("{what} at N = {load}, kappa = {kappa}, alpha = {alpha}, camber {camber}");
            agreement.near(&what, value, expected, &relative(1e-9, expected, 1.0));
        }
    }
    agreement.assert();
}

#[test]
fn mf52_example() {
    let file = read("mf52_example.tir", &text("tire/mf52_example.tir"), FileAxes::IsoW);
    assert_eq!(file.dialect.name, "MF 5.2");
    let law = law(&file, Usage { beyond: BeyondFit::Extrapolate, ..PLAIN });
    let mut agreement = Agreement::on("MF 5.2");
    let rows = rows(&text("tire/mf52_example.csv"));
    assert_eq!(rows.len(), 144);
    for row in rows {
        let [load, kappa, alpha, camber, speed, fx, fy, mx, my, mz, sigma_kappa, sigma_alpha]: [f64; 12] =
            row.try_into().expect("twelve columns");
        let f = at(&law, [load, kappa, alpha, camber, speed]);
        let [lateral, longitudinal] = law.relaxation_lengths(load, camber);
        for (what, value, expected) in [
            ("Fx", f.longitudinal, fx),
            ("Fy", f.lateral, fy),
            ("Mx", f.overturning_moment, mx),
            ("My", f.rolling_moment, my),
            ("Mz", f.aligning_moment, mz),
            ("longitudinal relaxation length", longitudinal, sigma_kappa),
            ("lateral relaxation length", lateral, sigma_alpha),
        ] {
            let what = format!("{what} at N = {load}, kappa = {kappa}, alpha = {alpha}, camber {camber}");
            agreement.near(&what, value, expected, &relative(1e-10, expected, 1e-2));
        }
    }
    agreement.assert();
}

/// The coefficients of the motorcycle formula as a property file: its axes are those of the book, its length the crown radius.
fn as_property_file(p: &MagicFormulaMotorcycleParameters) -> String {
    let (x, y, z) = (&p.longitudinal, &p.lateral, &p.aligning);
    let entries = [
        ("UNLOADED_RADIUS", p.crown_radius),
        ("FNOMIN", p.nominal_load),
        ("PCX1", x.Cx),
        ("PDX1", x.pDx1),
        ("PDX2", x.pDx2),
        ("PEX1", x.pEx1),
        ("PEX2", x.pEx2),
        ("PEX3", x.pEx3),
        ("PEX4", x.pEx4),
        ("PKX1", x.pKx1),
        ("PKX2", x.pKx2),
        ("PKX3", x.pKx3),
        ("RBX1", x.rBx1),
        ("RBX2", x.rBx2),
        ("RCX1", x.Cx_alpha),
        ("PCY1", y.Cy),
        ("PCY2", y.C_gamma),
        ("PDY1", y.pDy1),
        ("PDY2", y.pDy2),
        ("PDY3", y.pDy3),
        ("PEY1", y.pEy1),
        ("PEY2", y.pEy2),
        ("PEY4", y.pEy4),
        ("PEY5", y.E_gamma),
        ("PKY1", y.pKy1),
        ("PKY2", y.pKy2),
        ("PKY3", y.pKy3),
        ("PKY4", y.pKy4),
        ("PKY5", y.pKy5),
        ("PKY6", y.pKy6),
        ("PKY7", y.pKy7),
        ("RBY1", y.rBy1),
        ("RBY2", y.rBy2),
        ("RBY3", y.rBy3),
        ("RCY1", y.Cy_kappa),
        ("QBZ1", z.qBz1),
        ("QBZ2", z.qBz2),
        ("QBZ5", z.qBz5),
        ("QBZ9", z.qBz9),
        ("QBZ10", z.qBz10),
        ("QCZ1", z.Ct),
        ("QDZ1", z.qDz1),
        ("QDZ2", z.qDz2),
        ("QDZ3", z.qDz3),
        ("QDZ4", z.qDz4),
        ("QDZ8", z.qDz8),
        ("QDZ9", z.qDz9),
        ("QDZ10", z.qDz10),
        ("QDZ11", z.qDz11),
        ("QEZ1", z.qEz1),
        ("QEZ2", z.qEz2),
        ("QEZ5", z.qEz5),
        ("QHZ3", z.qHz3),
        ("QHZ4", z.qHz4),
    ];
    let body: String = entries.iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
    format!("[UNITS]\nLENGTH = 'meter'\n[MODEL]\nPROPERTY_FILE_FORMAT = 'PAC_MC'\n{body}")
}

#[test]
fn pac_mc_is_the_motorcycle_formula() {
    #[derive(Deserialize)]
    struct File {
        magic_formula_motorcycle: MagicFormulaMotorcycleParameters,
    }
    let yaml = repository_text("models/tires/sel04_120_70.yaml");
    let mut parameters = serde_yaml::from_str::<File>(&yaml).expect("a tire").magic_formula_motorcycle;
    // the square of camber in the slope of the trail, which PAC_MC does not have
    parameters.aligning.qBz6 = 0.0;
    let file = read("sel04.tir", &as_property_file(&parameters), FileAxes::AdaptedSae);
    // the motorcycle formula here is the mirror image of its publication, which rBy3 alone tells
    let usage = Usage { side: Side::Mirrored, axes: FileAxes::AdaptedSae, beyond: BeyondFit::Extrapolate, ..PLAIN };
    let (law, other) = (law(&file, usage), parameters.law().expect("a tire"));
    let mut agreement = Agreement::on("PAC_MC");
    for load in [600.0, 1100.0, 1900.0] {
        for angle in [-0.12, -0.02, 0.01, 0.08_f64] {
            for camber in [-0.7, -0.2, 0.1, 0.5] {
                for longitudinal in [-0.08, 0.0, 0.03] {
                    // one takes the slip angle, the other one number for all
                    let f = law.friction(&Slip { load, lateral: angle.tan(), longitudinal, camber, speed: 20.0 });
                    let expected = other.friction(&Slip { load, lateral: angle, longitudinal, camber, speed: 20.0 });
                    let what = format!("at N = {load}, alpha = {angle}, camber {camber}, kappa = {longitudinal}");
                    let mut near = |name: &str, value: f64, expected: f64| {
                        agreement.near(&format!("{name} {what}"), value, expected, &relative(1e-10, expected, 1.0))
                    };
                    near("Fx", f.longitudinal, expected.longitudinal);
                    near("Fy", f.lateral, expected.lateral);
                    if longitudinal == 0.0 {
                        // the cosine of the one number, 1/√(1 + a²), against that of the angle
                        near("Mz", f.aligning_moment / angle.cos(), expected.aligning_moment * (1.0 + angle * angle).sqrt());
                    }
                }
            }
        }
    }
    agreement.assert();
}
