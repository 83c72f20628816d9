//! Water on one surface, the artists' levels, and evaporation, integrated in small steps.
//!
//! Right-hand sides with every limit as a branch, stepped by Runge and Kutta's rule. A step that ends in another branch
//! than it began is cut in halves until it is shorter than a nanosecond: no event is ever solved for.

use crate::numerics::{bisect, simpson};

/// Shortest step: events are met to this. Units: s.
const SHORTEST_S: f64 = 1e-9;

/// What a surface does with water. Units as in the names.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    /// Full pores.
    pub pores_mm: f64,
    /// Film that does not run off.
    pub texture_mm: f64,
    /// Manning's n.
    pub manning_n: f64,
    /// Fall.
    pub slope: f64,
    /// Flow path.
    pub length_m: f64,
    /// Horton's f₀; 0 = lets nothing in.
    pub initial_mm_h: f64,
    /// Horton's f_c.
    pub final_mm_h: f64,
    /// Horton's k.
    pub decay_per_h: f64,
    /// Recovery of the used share while nothing infiltrates.
    pub recovery_per_s: f64,
}

/// Pores, film, rain, evaporated, infiltrated, drained (mm), Horton's time (s).
pub type Water = [f64; 7];

impl Ground {
    /// Horton's capacity. Units: mm/s.
    pub fn capacity_mm_s(&self, tau: f64) -> f64 {
        (self.final_mm_h + (self.initial_mm_h - self.final_mm_h) * (-self.decay_per_h * tau / 3600.0).exp()) / 3600.0
    }

    fn branch(&self, y: &Water, rain: f64, evaporation: f64) -> u8 {
        let full = y[0] >= self.pores_mm * (1.0 - 1e-12);
        if y[1] > self.texture_mm {
            4
        } else if y[1] > 1e-12 || (full && rain - evaporation > self.capacity_mm_s(y[6])) {
            3
        } else if full && rain > evaporation {
            2
        } else if y[0] > 0.0 || rain > evaporation {
            1
        } else {
            0
        }
    }

    fn rates(&self, branch: u8, y: &Water, rain: f64, evaporation: f64) -> Water {
        let tau = y[6];
        let k = self.decay_per_h / 3600.0;
        let used = 1.0 - (-k * tau).exp();
        let recovering = if self.initial_mm_h > 0.0 {
            -self.recovery_per_s * used / (k * (1.0 - used))
        } else {
            0.0
        };
        match branch {
            0 => [0.0, 0.0, rain, rain, 0.0, 0.0, recovering],
            1 => [rain - evaporation, 0.0, rain, evaporation, 0.0, 0.0, recovering],
            2 => {
                let in_soil = rain - evaporation;
                let speed = in_soil / self.capacity_mm_s(tau);
                [0.0, 0.0, rain, evaporation, in_soil, 0.0, speed]
            }
            _ => {
                let soaked = self.capacity_mm_s(tau);
                let above_m = ((y[1] - self.texture_mm) * 1e-3).max(0.0);
                let drained = 1e3 * self.slope.sqrt() / (self.manning_n * self.length_m) * above_m.powf(5.0 / 3.0);
                let clock = if soaked > 0.0 { 1.0 } else { 0.0 };
                let change = rain - evaporation - soaked - drained;
                [0.0, change, rain, evaporation, soaked, drained, clock]
            }
        }
    }

    /// A step may leave the pores too full or the film below nothing by what it overshot; that goes where it belongs.
    fn settled(&self, mut y: Water) -> Water {
        if y[0] > self.pores_mm {
            y[1] += y[0] - self.pores_mm;
            y[0] = self.pores_mm;
        }
        if y[1] < 0.0 {
            // The soil or the air took more than there was: the soil less, or the pores go on with it.
            y[if self.initial_mm_h > 0.0 { 4 } else { 0 }] += y[1];
            y[1] = 0.0;
        }
        if y[0] < 0.0 {
            y[3] += y[0];
            y[0] = 0.0;
        }
        y
    }

    fn step(&self, y: &Water, rain: f64, evaporation: f64, h: f64) -> Water {
        let branch = self.branch(y, rain, evaporation);
        let shift = |k: &Water, h: f64| -> Water { core::array::from_fn(|i| y[i] + h * k[i]) };
        let rates = |y: &Water| self.rates(branch, y, rain, evaporation);
        let k1 = rates(y);
        let k2 = rates(&shift(&k1, 0.5 * h));
        let k3 = rates(&shift(&k2, 0.5 * h));
        let k4 = rates(&shift(&k3, h));
        let next = core::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        let settled = self.settled(next);
        if h <= SHORTEST_S || (settled == next && self.branch(&next, rain, evaporation) == branch) {
            return settled;
        }
        let middle = self.step(y, rain, evaporation, 0.5 * h);
        self.step(&middle, rain, evaporation, 0.5 * h)
    }

    /// The water after `duration_s` of constant rain and evaporation (mm/h), in steps of `h` or less.
    pub fn advanced(&self, mut y: Water, rain_mm_h: f64, evaporation_mm_h: f64, duration_s: f64, h: f64) -> Water {
        let steps = (duration_s / h).ceil().max(1.0);
        let mut n = 0.0;
        while n < steps {
            y = self.step(&y, rain_mm_h / 3600.0, evaporation_mm_h / 3600.0, duration_s / steps);
            n += 1.0;
        }
        y
    }

    /// What the dry soil takes in `t` s under standing water: sums of the capacity over spans short against its decay.
    /// Units: mm.
    pub fn flooded_mm(&self, t: f64) -> f64 {
        let spans = (self.decay_per_h * t / 3600.0).ceil().clamp(1.0, 1e4);
        let edge = |i: f64| t * i / spans;
        let mut sum = 0.0;
        let mut i = spans;
        // From the end: small amounts first.
        while i > 0.0 {
            sum += simpson(edge(i - 1.0), edge(i), 300, |tau| self.capacity_mm_s(tau));
            i -= 1.0;
        }
        sum
    }

    /// When constant rain on the dry soil begins to stand: what the curve let in until its capacity was down to the rain,
    /// over the rain. Units: s.
    pub fn ponded_after_s(&self, rain_mm_h: f64) -> f64 {
        let tau = bisect(0.0, 40.0 * 3600.0 / self.decay_per_h, |tau| {
            self.capacity_mm_s(tau) * 3600.0 - rain_mm_h
        });
        self.flooded_mm(tau) / (rain_mm_h / 3600.0)
    }

    /// κ of the drain κ w^(5/3), w in mm: Manning's law over a plane. Units: mm^(−2/3)/s.
    pub fn drain(&self) -> f64 {
        let si = self.slope.sqrt() / self.manning_n / self.length_m;
        // 1e3 mm a metre: w in mm is 1e-3 w in m.
        1e3 * si * 1e-3_f64.powf(5.0 / 3.0)
    }

    /// When constant rain on the dry soil begins to stand. Units: s. By stepping Horton's time with what infiltrates.
    pub fn ponding_time_s(&self, rain_mm_h: f64, h: f64) -> f64 {
        let rain = rain_mm_h / 3600.0;
        let (mut t, mut tau) = (0.0, 0.0);
        loop {
            let rate = |tau: f64| rain / self.capacity_mm_s(tau);
            let k1 = rate(tau);
            let k2 = rate(tau + 0.5 * h * k1);
            let k3 = rate(tau + 0.5 * h * k2);
            let k4 = rate(tau + h * k3);
            let next = tau + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            if self.capacity_mm_s(next) <= rain {
                let share = bisect(0.0, 1.0, |s| self.capacity_mm_s(tau + s * (next - tau)) - rain);
                return t + share * h;
            }
            (t, tau) = (t + h, next);
        }
    }
}

/// Speeds (1/s) of one artists' level in light, moderate and heavy rain, its fall, its target.
#[derive(Debug, Clone, Copy)]
pub struct Level {
    /// Rise at relative intensities 0.33, 0.66, 1.
    pub rise: [f64; 3],
    /// Fall when dry.
    pub fall: f64,
    /// Where it goes.
    pub target: f64,
}

/// The artists' rules. Levels in the order wetness, holes, puddles.
#[derive(Debug, Clone, Copy)]
pub struct Artist {
    /// By a share of what is missing, instead of at a constant rate.
    pub exponential: bool,
    /// The levels.
    pub levels: [Level; 3],
    /// Wetness from which holes and puddles fill.
    pub gate: f64,
    /// Rain up to this floods nothing. Units: mm/h.
    pub drizzle_mm_h: f64,
    /// Dry time before anything falls. Units: s.
    pub delay_s: f64,
}

/// Wetness, holes, puddles, dry time.
pub type Levels = [f64; 4];

impl Artist {
    /// dL/dt of a speed read off the rows of table T3.
    fn rise(level: &Level, rain_mm_h: f64) -> f64 {
        let rates = [0.0, 2.0, 5.0, 10.0];
        let speeds = [0.0, level.rise[0], level.rise[1], level.rise[2]];
        for i in 0..3 {
            if rain_mm_h <= rates[i + 1] {
                return speeds[i] + (speeds[i + 1] - speeds[i]) * (rain_mm_h - rates[i]) / (rates[i + 1] - rates[i]);
            }
        }
        speeds[3]
    }

    /// Small steps of forward Euler (linear law) or of the trapezium rule (exponential law).
    pub fn advanced(&self, mut y: Levels, rain_mm_h: f64, duration_s: f64, h: f64) -> Levels {
        let steps = (duration_s / h).ceil().max(1.0);
        let h = duration_s / steps;
        let mut n = 0.0;
        while n < steps {
            n += 1.0;
            let raining = rain_mm_h > 0.0;
            y[3] = if raining { 0.0 } else { y[3] + h };
            for (i, level) in self.levels.iter().enumerate() {
                let floods = rain_mm_h > self.drizzle_mm_h && y[0] >= self.gate;
                let toward = level.target;
                if raining && y[i] < toward && (i == 0 || floods) {
                    let speed = Self::rise(level, rain_mm_h);
                    y[i] = if self.exponential {
                        toward - (toward - y[i]) * (1.0 - 0.5 * speed * h) / (1.0 + 0.5 * speed * h)
                    } else {
                        (y[i] + speed * h).min(toward)
                    };
                } else if !raining && y[3] > self.delay_s {
                    y[i] = if self.exponential {
                        y[i] * (1.0 - 0.5 * level.fall * h) / (1.0 + 0.5 * level.fall * h)
                    } else {
                        (y[i] - level.fall * h).max(0.0)
                    };
                }
            }
        }
        y
    }
}

/// The rows of digest C, table 4.2, joined by lines: 0, 2, 5, 10 mm/h are 0, 0.33, 0.66, 1.
pub fn relative_intensity(rain_mm_h: f64) -> f64 {
    if rain_mm_h <= 2.0 {
        0.165 * rain_mm_h
    } else if rain_mm_h <= 5.0 {
        0.11 + 0.11 * rain_mm_h
    } else if rain_mm_h <= 10.0 {
        0.32 + 0.068 * rain_mm_h
    } else {
        1.0
    }
}

/// Saturation vapour pressure over water. Units: °C in, hPa out. Bolton 1980 as printed.
pub fn saturation_hpa(t: f64) -> f64 {
    6.112 * (17.67 * t / (t + 243.5)).exp()
}

/// Penman 1948 in the units of the paper: energy in mm/day, vapour in hPa, the slope by differences. Units: mm/h.
pub fn penman_mm_h(t: f64, humidity: f64, wind: f64, net_w_m2: f64, pressure_pa: f64) -> f64 {
    let h = 1e-4;
    let slope_pa = 100.0 * (saturation_hpa(t + h) - saturation_hpa(t - h)) / (2.0 * h);
    let latent = 2.501e6 - 2361.0 * t;
    let gamma_pa = 1005.0 * pressure_pa / (0.622 * latent);
    let energy_mm_day = net_w_m2 * 86_400.0 / latent;
    let air_mm_day = dalton_mm_day(t, humidity, wind);
    (slope_pa * energy_mm_day + gamma_pa * air_mm_day) / (slope_pa + gamma_pa) / 24.0
}

/// Penman's drying power of the air. Units: mm/day.
pub fn dalton_mm_day(t: f64, humidity: f64, wind: f64) -> f64 {
    0.26 * (1.0 + 0.54 * wind) * (saturation_hpa(t) - humidity * saturation_hpa(t))
}

/// Dew point by halving. Units: °C.
pub fn dew_point_c(t: f64, humidity: f64) -> f64 {
    bisect(-200.0, t, |x| saturation_hpa(x) - humidity * saturation_hpa(t))
}

/// Value at `t` of a function that is linear (or held) between keys `(time, value, held)`, from the right.
pub fn value_along(keys: &[(f64, f64, bool)], t: f64) -> f64 {
    let mut value = keys[0].1;
    for (i, key) in keys.iter().enumerate() {
        if key.0 <= t {
            value = match keys.get(i + 1) {
                Some(next) if !key.2 => {
                    let share = (t - key.0) / (next.0 - key.0);
                    key.1 - share * key.1 + share * next.1
                }
                _ => key.1,
            };
        }
    }
    value
}

/// Mean over [a, b] of a function that is linear (or held) between keys `(time, value, held)`: sums of trapezia between
/// all keys and ends.
pub fn mean_along(keys: &[(f64, f64, bool)], a: f64, b: f64) -> f64 {
    let value = |t: f64, left: bool| {
        // The value just before or just after t.
        let at = keys.iter().rposition(|key| if left { key.0 < t } else { key.0 <= t });
        match at {
            None => keys[0].1,
            Some(i) if i + 1 == keys.len() || keys[i].2 => keys[i].1,
            Some(i) => keys[i].1 + (keys[i + 1].1 - keys[i].1) * (t - keys[i].0) / (keys[i + 1].0 - keys[i].0),
        }
    };
    let mut ends: Vec<f64> = keys.iter().map(|key| key.0).filter(|&t| t > a && t < b).collect();
    ends.insert(0, a);
    ends.push(b);
    let area: f64 = ends
        .windows(2)
        .map(|w| 0.5 * (value(w[0], false) + value(w[1], true)) * (w[1] - w[0]))
        .sum();
    area / (b - a)
}
