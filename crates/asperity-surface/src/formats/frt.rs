//! FRT: MicroProf and other profilometers of FRT; read only.
//!
//! Little-endian. The file contains `FRTM_GLIDERV1.00`, the number of blocks (u16), and the blocks: type u16,
//! size u32, content.
//!
//! ```text
//! 0x66  sizes along x and y, bits per height, 3 u32    0x0b  heights
//! 0x67  lengths along x and y in metres, 2 f64         0x7d  number of images u32, u32, and the images:
//! 0x6c  u32, metres in a unit of the heights f64             kind, sizes along x and y, bits, 4 u32, and numbers
//! ```
//!
//! Heights are u16 or i32, x fastest, from the last y to the first: the bottom line of the image is first, in
//! other formats the top one. 1 is a missing height. Channels are the block 0x0b or, without it, the images
//! of a topography (kind 4), and images of a thickness (0x80).

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::{Decoded, Fault, Scan, choose, distinct, from_last_y_to_first};
use asperity_base::error::Defect;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"FRTM_GLIDERV1.00";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("frt", defect);
    let mut file = File::read(bytes).map_err(fault)?;
    let rasters = std::mem::take(&mut file.rasters);
    if rasters.is_empty() {
        return Err(fault(Defect::Missing("block of heights")));
    }
    let channels = distinct(rasters.iter().map(|(name, _)| (*name).to_owned()));
    let chosen = choose(&channels, channel)?;
    let unit = file.unit.ok_or(fault(Defect::Missing("block of the unit of the heights")))?;
    let raster = &rasters[chosen].1;
    let mut heights = raster.heights(|number| if number == 1.0 { f64::NAN } else { number * unit });
    from_last_y_to_first(&mut heights);
    let [nx, ny] = raster.shape;
    let pitch = [file.lengths[0] / nx as f64, file.lengths[1] / ny as f64];
    Ok(Scan::of_channel("frt", channels, chosen, pitch, heights))
}

/// The required parts of the blocks.
struct File<'a> {
    lengths: [f64; 2],
    unit: Option<f64>,
    rasters: Vec<(&'static str, Raster<'a>)>,
}

impl<'a> File<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self, Defect> {
        let mut file = Cursor::new(bytes, Order::Little, "the file");
        file.take(MAGIC.len())?;
        let (mut header, mut single, mut several) = (None, None, None);
        let (mut lengths, mut unit) = ([f64::NAN; 2], None);
        for _ in 0..file.u16()? {
            let (kind, size) = (file.u16()?, file.u32()?);
            let mut block = Cursor::new(file.take(size as usize)?, Order::Little, "a block");
            match kind {
                0x66 => header = Some([block.u32()?, block.u32()?, block.u32()?]),
                0x67 => lengths = [block.f64()?, block.f64()?],
                0x6c => unit = block.u32().and_then(|_| block.f64()).map(Some)?,
                0x0b => single = Some(block),
                0x7d => several = Some(block),
                _ => {}
            }
        }
        let mut rasters = Vec::new();
        let topographies = single.is_none();
        if let Some(block) = single {
            let header = header.ok_or(Defect::Missing("block of the sizes"))?;
            rasters.push(("topography", raster(header, block.rest())?));
        }
        if let Some(mut block) = several {
            let count = block.u32()?;
            block.u32()?;
            for _ in 0..count {
                let kind = block.u32()?;
                let raster = raster([block.u32()?, block.u32()?, block.u32()?], block.rest())?;
                block.take(raster.bytes())?;
                match kind & 0xffff {
                    4 if topographies => rasters.push(("topography", raster)),
                    0x80 => rasters.push(("thickness", raster)),
                    _ => {}
                }
            }
        }
        Ok(Self { lengths, unit, rasters })
    }
}

fn raster([nx, ny, bits]: [u32; 3], data: &[u8]) -> Result<Raster<'_>, Defect> {
    let number = match bits {
        16 => Number::Uint16,
        32 => Number::Int32,
        _ => {
            let found = bits.to_string();
            return Err(Defect::Value { what: "the number of bits per height", found, expected: "16 or 32" });
        }
    };
    Raster::new(shape([nx, ny])?, number, Order::Little, data)
}
