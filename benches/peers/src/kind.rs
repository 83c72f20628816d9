//! What is drawn.

/// Most visible drops that are accepted.
pub const MOST: u32 = 1_000_000;

/// Whose rain falls in the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Nobody's.
    None,
    /// Nobody's, and the scene is lit.
    NoneLit,
    /// Ours with all defaults: streaks, haze, splashes, wet surfaces; the scene is lit.
    Rain,
    /// Our streaks alone.
    RainNearOnly,
    /// A GPU effect of `bevy_hanabi`, quads of our streaks' mean size.
    Hanabi,
    /// Rain of `bevy_weather`, its quads made as large as ours.
    Weather,
    /// Rain of `bevy_weather`, its quads as large as it makes them.
    WeatherOwn,
    /// Our draw pass beside bare quads, without Bevy.
    Quads,
}

impl Kind {
    /// Whether the scene is lit. Where nothing but rain in the air is drawn it is not: the light takes several times as
    /// long as 10 000 drops, and what it varies by hides them.
    pub fn is_lit(self) -> bool {
        matches!(self, Self::NoneLit | Self::Rain)
    }
}

/// The kind and the number of visible drops that the command line asks for.
///
/// # Errors
/// Says which word is wrong or missing.
pub fn read(words: &[String]) -> Result<(Kind, u32), String> {
    let Some(name) = words.first() else {
        return Err("KIND is missing".into());
    };
    let kind = match name.as_str() {
        "none" => Kind::None,
        "none_lit" => Kind::NoneLit,
        "rain" => Kind::Rain,
        "rain_near_only" => Kind::RainNearOnly,
        "hanabi" => Kind::Hanabi,
        "weather" => Kind::Weather,
        "weather_own" => Kind::WeatherOwn,
        "quads" => Kind::Quads,
        other => return Err(format!("there is no kind {other:?}")),
    };
    if let Some(extra) = words.get(2) {
        return Err(format!("{extra:?} is too much"));
    }
    let count = match (words.get(1), kind) {
        (None, Kind::None | Kind::NoneLit) => 0,
        (None, _) => return Err("COUNT is missing".into()),
        (Some(word), _) => match word.parse::<u32>() {
            Ok(n) if (1..=MOST).contains(&n) => n,
            _ => return Err(format!("COUNT must be a whole number from 1 to {MOST}, not {word:?}")),
        },
    };
    Ok((kind, count))
}
