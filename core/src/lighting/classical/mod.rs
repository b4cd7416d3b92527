//! Environment maps, infinitely far.
