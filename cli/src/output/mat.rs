//! MATLAB files, level 5, without compression: matrices of doubles, and column cell arrays of texts.
//!
//! Source: The MathWorks, *MAT-File Format*, R2023b, chapter 1 (level 5: data elements, tags, subelements of arrays).

use nalgebra::DMatrix;

// types of data elements
const INT8: u32 = 1;
const UINT16: u32 = 4;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;

// classes of arrays
const CELL: u32 = 1;
const CHAR: u32 = 4;
const FULL: u32 = 6;

/// The file.
pub(super) fn file(numbers: &[(&str, &DMatrix<f64>)], texts: &[(String, Vec<String>)]) -> Vec<u8> {
    let mut bytes = format!("{:116}", format!("MATLAB 5.0 MAT-file, written by fastbike {}", env!("CARGO_PKG_VERSION"))).into_bytes();
    // no subsystem data, version 1, little endian
    bytes.extend([0; 8]);
    bytes.extend([0x00, 0x01, b'I', b'M']);
    for (name, m) in numbers {
        let data: Vec<u8> = m.iter().flat_map(|e| e.to_le_bytes()).collect();
        bytes.extend(array(FULL, (m.nrows(), m.ncols()), name, &element(DOUBLE, &data)));
    }
    for (name, list) in texts {
        let cells: Vec<u8> = list.iter().flat_map(|text| array(CHAR, (1, text.encode_utf16().count()), "", &characters(text))).collect();
        bytes.extend(array(CELL, (list.len(), 1), name, &cells));
    }
    bytes
}

/// A data element: tag, data, padding to a multiple of eight bytes.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes: Vec<u8> = [kind, data.len() as u32].iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn characters(text: &str) -> Vec<u8> {
    element(UINT16, &text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>())
}

/// An array: flags with the class, dimensions, name, contents.
fn array(class: u32, (rows, columns): (usize, usize), name: &str, contents: &[u8]) -> Vec<u8> {
    let words = |values: [u32; 2]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let mut data = element(UINT32, &words([class, 0]));
    data.extend(element(INT32, &words([rows as u32, columns as u32])));
    data.extend(element(INT8, name.as_bytes()));
    data.extend(contents);
    element(MATRIX, &data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_padded_and_the_header_has_its_length() {
        let m = DMatrix::from_row_slice(1, 1, &[2.5]);
        let bytes = file(&[("A", &m)], &[("states".to_owned(), vec!["steer.angle".to_owned()])]);
        assert_eq!((bytes.len() % 8, &bytes[126..128]), (0, &b"IM"[..]));
        // tag and size of the first array: flags, dimensions, name, data
        assert_eq!(bytes[128..136], [14, 0, 0, 0, 64, 0, 0, 0]);
        assert_eq!(bytes[192..200], 2.5f64.to_le_bytes());
    }
}
