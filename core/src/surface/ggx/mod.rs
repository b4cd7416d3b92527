//! ggx
