//! What a drop does when it hits: splash threshold, crown, secondary drops.
