//! temp
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    pub tolerance: f64,
    pub horizon: Horizon,
}
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    Seconds(f64),
    Bounces(u32),
}
impl core::fmt::Display for Accuracy {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} m over {:?}", self.tolerance, self.horizon)
    }
}
pub fn parse_tolerance(t: &str) -> Result<f64, String> {
    t.trim_end_matches("mm").parse::<f64>().map(|x| x * 1e-3).map_err(|e| e.to_string())
}
impl core::str::FromStr for Horizon {
    type Err = String;
    fn from_str(t: &str) -> Result<Self, String> {
        if let Some(x) = t.strip_suffix("bounces") {
            x.parse().map(Horizon::Bounces).map_err(|_| "x".to_owned())
        } else {
            t.trim_end_matches('s').parse().map(Horizon::Seconds).map_err(|_| "x".to_owned())
        }
    }
}
