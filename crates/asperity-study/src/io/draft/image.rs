//! HDF5 file in memory with one array, whose chunks are packed already. `hdf5-pure` packs chunks on one
//! thread, but copies those of another file as they are.
//!
//! HDF5 File Format Specification, version 3.0: superblock of version 2, object headers of version 2, chunks
//! in a B-tree of version 1.

/// Name of the array.
pub(super) const NAME: &str = "a";

/// No address.
const UNDEFINED: u64 = u64::MAX;
/// Size of the superblock.
const SUPERBLOCK: usize = 48;

/// Creates the image of an array of numbers of double precision with this `shape`. Its `chunks` of this shape
/// are in the order of their places, shuffled and deflated at `level`.
pub(super) fn image(shape: &[u64], chunk: &[u64], chunks: &[Vec<u8>], level: u32) -> Vec<u8> {
    let root_at = SUPERBLOCK;
    let array_at = root_at + root(0).len();
    let tree_at = array_at + array(shape, chunk, level, 0).len();
    let data_at = tree_at + tree(shape, chunk, chunks, 0).len();
    let end = data_at + chunks.iter().map(Vec::len).sum::<usize>();

    let mut image = Vec::with_capacity(end);
    image.extend(b"\x89HDF\r\n\x1a\n");
    // Version, size of addresses, size of lengths, flags.
    image.extend([2, 8, 8, 0]);
    for address in [0, UNDEFINED, end as u64, root_at as u64] {
        image.extend(address.to_le_bytes());
    }
    close(&mut image);
    image.extend(root(array_at as u64));
    image.extend(array(shape, chunk, level, tree_at as u64));
    image.extend(tree(shape, chunk, chunks, data_at as u64));
    chunks.iter().for_each(|chunk| image.extend(chunk));
    image
}

/// Header of the root group, with a link to the array.
fn root(array_at: u64) -> Vec<u8> {
    // Version, flags, addresses of the heap and of the index that there are not.
    let info = [&[0, 0][..], &UNDEFINED.to_le_bytes(), &UNDEFINED.to_le_bytes()].concat();
    let link = [&[1, 0, NAME.len() as u8][..], NAME.as_bytes(), &array_at.to_le_bytes()].concat();
    header(&[(0x02, info), (0x06, link)])
}

/// Header of the array.
fn array(shape: &[u64], chunk: &[u64], level: u32, tree_at: u64) -> Vec<u8> {
    let rank = shape.len() as u8;
    let mut space = vec![2, rank, 0, 1];
    shape.iter().for_each(|size| space.extend(size.to_le_bytes()));
    // IEEE 754, little-endian: sign at bit 63, exponent of 11 bits from 52 on, mantissa of 52 bits from 0 on.
    let mut number = vec![0x11, 0x20, 63, 0, 8, 0, 0, 0, 0, 0, 64, 0, 52, 11, 0, 52];
    number.extend(1023_u32.to_le_bytes());
    // Chunks have places as they are written; the value of others is undefined.
    let fill = vec![3, 0b0000_0011];
    // The number of dimensions with that of the bytes of a value, and their sizes.
    let mut layout = vec![3, 2, rank + 1];
    layout.extend(tree_at.to_le_bytes());
    chunk.iter().chain(&[8]).for_each(|size| layout.extend((*size as u32).to_le_bytes()));
    // Shuffle (2) with the size of a value, deflate (1) with its level. Either may be left out for a chunk.
    let mut filters = vec![2, 2];
    for [number, value] in [[2, 8], [1, level]] {
        filters.extend([number as u8, 0, 1, 0, 1, 0]);
        filters.extend(value.to_le_bytes());
    }
    header(&[(0x01, space), (0x03, number), (0x05, fill), (0x08, layout), (0x0b, filters)])
}

/// Object header with these messages, by their types.
fn header(messages: &[(u8, Vec<u8>)]) -> Vec<u8> {
    let size: usize = messages.iter().map(|(_, message)| 4 + message.len()).sum();
    // Version; the size of the messages has 4 bytes.
    let mut header = [&b"OHDR"[..], &[2, 2], &(size as u32).to_le_bytes()].concat();
    for (kind, message) in messages {
        header.push(*kind);
        header.extend((message.len() as u16).to_le_bytes());
        header.push(0);
        header.extend(message);
    }
    close(&mut header);
    header
}

/// Index of the chunks in one node.
fn tree(shape: &[u64], chunk: &[u64], chunks: &[Vec<u8>], data_at: u64) -> Vec<u8> {
    // Chunks of raw data, no levels below.
    let mut tree = [&b"TREE"[..], &[1, 0], &(chunks.len() as u16).to_le_bytes()].concat();
    [UNDEFINED; 2].iter().for_each(|sibling| tree.extend(sibling.to_le_bytes()));
    let counts: Vec<u64> = shape.iter().zip(chunk).map(|(size, chunk)| size.div_ceil(*chunk)).collect();
    let mut address = data_at;
    // The place after the last chunk ends the node.
    for index in 0..=chunks.len() {
        let size = chunks.get(index).map_or(0, Vec::len);
        tree.extend((size as u32).to_le_bytes());
        tree.extend([0; 4]);
        let mut rest = index as u64;
        let mut place: Vec<u64> = counts
            .iter()
            .zip(chunk)
            .enumerate()
            .rev()
            .map(|(axis, (count, chunk))| {
                let at = if axis == 0 { rest } else { rest % count };
                rest /= count;
                at * chunk
            })
            .collect();
        place.reverse();
        place.iter().chain(&[0]).for_each(|at| tree.extend(at.to_le_bytes()));
        if index < chunks.len() {
            tree.extend(address.to_le_bytes());
            address += size as u64;
        }
    }
    tree
}

/// Ends a structure with its checksum, Jenkins' lookup3.
fn close(bytes: &mut Vec<u8>) {
    let checksum = lookup3(bytes);
    bytes.extend(checksum.to_le_bytes());
}

/// Bob Jenkins' hash `hashlittle` of lookup3.c (2006), in the public domain, from 0.
fn lookup3(bytes: &[u8]) -> u32 {
    // The numbers by their letters there.
    const A: usize = 0;
    const B: usize = 1;
    const C: usize = 2;
    const MIX: [(usize, usize, usize, u32); 6] =
        [(A, C, B, 4), (B, A, C, 6), (C, B, A, 8), (A, C, B, 16), (B, A, C, 19), (C, B, A, 4)];
    const END: [(usize, usize, u32); 7] =
        [(C, B, 14), (A, C, 11), (B, A, 25), (C, B, 16), (A, C, 4), (B, A, 14), (C, B, 24)];
    let mut state = [0xdead_beef_u32.wrapping_add(bytes.len() as u32); 3];
    let mut blocks = bytes.chunks(12).peekable();
    while let Some(block) = blocks.next() {
        for (value, word) in state.iter_mut().zip(block.chunks(4)) {
            let word = word.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
            *value = value.wrapping_add(word);
        }
        if blocks.peek().is_some() {
            for (x, y, z, turn) in MIX {
                state[x] = state[x].wrapping_sub(state[y]) ^ state[y].rotate_left(turn);
                state[y] = state[y].wrapping_add(state[z]);
            }
        } else {
            for (x, y, turn) in END {
                state[x] = (state[x] ^ state[y]).wrapping_sub(state[y].rotate_left(turn));
            }
        }
    }
    state[C]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_that_of_its_author() {
        // driver5 of lookup3.c.
        assert_eq!(lookup3(b""), 0xdead_beef);
        assert_eq!(lookup3(b"Four score and seven years ago"), 0x1777_0551);
    }
}
