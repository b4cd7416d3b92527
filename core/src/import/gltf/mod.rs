use super::budget::Meter;
use super::report::Report;
use super::{NormalsWhenAbsent, ReadScene, Resolver};
pub(super) fn scene(_: &[u8], _: &dyn Resolver, _: NormalsWhenAbsent, _: &mut Meter, _: &mut Report) -> ReadScene {
    None
}
