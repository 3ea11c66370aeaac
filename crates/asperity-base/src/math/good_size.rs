//! Fast transform lengths.

/// Returns the smallest even number ≥ `n` whose only prime factors are 2, 3 and 5. It has at most one factor
/// 5 and two factors 3, which the mixed-radix transforms handle about as fast as powers of two.
pub fn good_size(n: usize) -> usize {
    /// Odd factors of the sizes.
    const ODD: [usize; 6] = [1, 3, 5, 9, 15, 45];
    ODD.iter()
        .map(|&odd| {
            let mut size = 2 * odd;
            while size < n {
                size *= 2;
            }
            size
        })
        .min()
        .unwrap_or(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_least_of_its_kind() {
        assert_eq!(good_size(1), 2);
        assert_eq!(good_size(23), 24);
        assert_eq!(good_size(511), 512);
        assert_eq!(good_size(1023), 1024);
        assert_eq!(good_size(1025), 1152);
        for n in 1..2000 {
            let size = good_size(n);
            assert!(size >= n && size.is_multiple_of(2) && (n < 3 || size as f64 <= 1.34 * n as f64));
        }
    }
}
