//! NumPy archives: a ZIP file without compression, one `.npy` array in each entry.
//!
//! Source: NumPy Enhancement Proposal 1 (format version 1.0); PKWARE APPNOTE 6.3.9 (local headers, central directory);
//! CRC-32 of ISO 3309.

use nalgebra::DMatrix;

/// Matrices by rows, and one-dimensional arrays of texts.
pub(super) fn archive(numbers: &[(&str, &DMatrix<f64>)], texts: &[(String, Vec<String>)]) -> Vec<u8> {
    let matrices = numbers.iter().map(|(name, m)| ((*name).to_owned(), matrix(m)));
    let entries: Vec<(String, Vec<u8>)> = matrices.chain(texts.iter().map(|(name, list)| (name.clone(), strings(list)))).collect();
    zip(&entries)
}

fn npy(kind: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // the data begin at a multiple of 64 bytes
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

fn matrix(m: &DMatrix<f64>) -> Vec<u8> {
    let data: Vec<u8> = m.transpose().iter().flat_map(|e| e.to_le_bytes()).collect();
    npy("<f8", &format!("({}, {})", m.nrows(), m.ncols()), &data)
}

fn strings(list: &[String]) -> Vec<u8> {
    let width = list.iter().map(|t| t.chars().count()).max().unwrap_or(0).max(1);
    let padded = list.iter().flat_map(|text| text.chars().map(u32::from).chain(std::iter::repeat(0)).take(width));
    let data: Vec<u8> = padded.flat_map(u32::to_le_bytes).collect();
    npy(&format!("<U{width}"), &format!("({},)", list.len()), &data)
}

/// Entries as they are, then the directory.
fn zip(entries: &[(String, Vec<u8>)]) -> Vec<u8> {
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for (name, data) in entries {
        let name = format!("{name}.npy");
        let offset = file.len() as u32;
        // version 2.0, no flags, stored, 1 January 1980
        let mut common = Vec::new();
        common.extend([20u16, 0, 0, 0, 0x21].iter().flat_map(|v| v.to_le_bytes()));
        common.extend([crc32(data), data.len() as u32, data.len() as u32].iter().flat_map(|v| v.to_le_bytes()));
        common.extend([name.len() as u16, 0].iter().flat_map(|v| v.to_le_bytes()));
        file.extend(b"PK\x03\x04");
        file.extend(&common);
        file.extend(name.as_bytes());
        file.extend(data);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        // no comment, first disk, no attributes
        directory.extend([0u8; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (start, count) = (file.len() as u32, entries.len() as u16);
    file.extend(&directory);
    file.extend(b"PK\x05\x06\x00\x00\x00\x00");
    file.extend([count, count].iter().flat_map(|v| v.to_le_bytes()));
    file.extend([directory.len() as u32, start].iter().flat_map(|v| v.to_le_bytes()));
    file.extend([0u8; 2]);
    file
}

fn crc32(data: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 });
    !data.iter().fold(!0, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksum_is_that_of_the_standard() {
        // the check value of CRC-32/ISO-HDLC
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn data_of_arrays_are_aligned() {
        let bytes = matrix(&DMatrix::from_row_slice(1, 2, &[1.0, 2.0]));
        assert_eq!(bytes.len() % 64, 16);
        assert_eq!(bytes[bytes.len() - 8..], 2f64.to_le_bytes());
    }
}
