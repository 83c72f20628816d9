//! Water thrown by wheels, hydroplaning, swept sources.
