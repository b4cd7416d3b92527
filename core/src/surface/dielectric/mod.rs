//! dielectric
