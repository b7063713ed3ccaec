//! Stand-in.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackError;
impl std::fmt::Display for TrackError {
    fn fmt(&self, _: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        Ok(())
    }
}
