//! Terminal velocity: measurements, the sources' fits, Beard 1976.
