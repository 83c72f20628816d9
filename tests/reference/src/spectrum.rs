//! Drop-size distributions: bulk quantities by brute-force sums.
