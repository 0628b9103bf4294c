//! Files packed by gzip, as scenes and meshes of pbrt often are.

use std::io::{Cursor, Read};

use flate2::read::MultiGzDecoder;
use foton_math::{Cancel, CancelReader};

use crate::limits::Budget;

/// What such files begin with.
const MARK: [u8; 2] = [0x1f, 0x8b];

/// A file without its packing; one that is not packed as it is. What it takes is taken from the budget.
pub(crate) fn unpacked(bytes: Vec<u8>, budget: &mut Budget, cancel: &Cancel) -> Result<Vec<u8>, String> {
    if !bytes.starts_with(&MARK) {
        return Ok(bytes);
    }
    let most = budget.left();
    let mut plain = Vec::new();
    let packed = MultiGzDecoder::new(CancelReader::new(Cursor::new(&bytes), cancel));
    let read = packed.take(most.saturating_add(1)).read_to_end(&mut plain);
    read.map_err(|error| format!("its packing is broken: {error}"))?;
    // Says why not, where that is more than there is left.
    budget.take(plain.len() as u64)?;
    Ok(plain)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::{Compression, write::GzEncoder};

    use super::*;

    #[test]
    fn a_packed_file_is_unpacked_within_the_budget() {
        let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
        packed.write_all(&[7; 100_000]).unwrap();
        let packed = packed.finish().unwrap();
        let read = |limit| unpacked(packed.clone(), &mut Budget::new(limit), &Cancel::default());
        assert_eq!(read(None).map(|plain| plain.len()), Ok(100_000));
        assert_eq!(unpacked(vec![1, 2], &mut Budget::new(None), &Cancel::default()), Ok(vec![1, 2]));
        let mut small = Budget::new(Some(0));
        small.take((4 << 20) - 1000).unwrap();
        assert!(unpacked(packed.clone(), &mut small, &Cancel::default()).is_err());
        assert!(unpacked(packed[..50].to_vec(), &mut Budget::new(None), &Cancel::default()).is_err());
    }
}
