// Pores and film of one texel over an interval: the twin of rain_core::weather::ColumnF32. Depths in mm, times in s.

// (1 - e^-x) / x for x >= 0.
fn rain_mean_decay(x: f32) -> f32 {
    if (x < 0.1) {
        return 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)));
    }
    return (1.0 - exp(-x)) / x;
}

// w^(2/3) for w >= 0.
fn rain_cbrt_square(w: f32) -> f32 {
    return select(0.0, exp2(log2(max(w, 1e-37)) * (2.0 / 3.0)), w > 1e-37);
}

// Infiltration capacity at tau, mm/s.
fn rain_soil_capacity(rules: ColumnRules, tau: f32) -> f32 {
    return rules.soil + rules.dry_soil * exp(-rules.soil_decay * tau);
}

// What infiltrates at capacity from tau to tau + t, mm.
fn rain_soil_depth(rules: ColumnRules, tau: f32, t: f32) -> f32 {
    let extra = rules.dry_soil * exp(-rules.soil_decay * tau);
    return t * (rules.soil + extra * rain_mean_decay(rules.soil_decay * t));
}

fn rain_soil_clock(rules: ColumnRules, tau: f32, t: f32) -> f32 {
    return min(tau + t, 30.0 / rules.soil_decay);
}

// tau after t without infiltration.
fn rain_soil_recovered(rules: ColumnRules, tau: f32, t: f32) -> f32 {
    if (tau <= 0.0 || rules.recovery <= 0.0) {
        return tau;
    }
    let k = rules.soil_decay;
    let x = rules.recovery * t;
    let back = x * rain_mean_decay(x);
    let dry = exp(-k * tau);
    if (k * tau < 0.5 && x < 0.01) {
        let grown = tau * (1.0 + 0.5 * k * tau * (1.0 + k * tau / 3.0 * (1.0 + 0.25 * k * tau)));
        return max(tau - back * grown, 0.0);
    }
    return max(-log(dry + (1.0 - dry) * back) / k, 0.0);
}

fn rain_film_rate(w: f32, net: f32, drain: f32) -> f32 {
    let water = max(w, 0.0);
    return net - drain * water * rain_cbrt_square(water);
}

// 1 / speed at which a film of `w` sinks under a net loss.
fn rain_film_slowness(w: f32, net: f32, drain: f32) -> f32 {
    return 1.0 / (drain * w * rain_cbrt_square(w) - net);
}

// Film `start` above the texture under a constant net supply for `left`: time used (less if it runs out), film then.
fn rain_film_flow(start: f32, net: f32, drain: f32, left: f32) -> vec2<f32> {
    if (drain <= 0.0) {
        let end = start + net * left;
        if (end < 0.0) {
            return vec2<f32>(start / -net, 0.0);
        }
        return vec2<f32>(left, end);
    }
    var w = start;
    var t = 0.0;
    let balance = select(0.0, pow(max(net, 1e-37) / drain, 0.6), net > 0.0);
    for (var step = 0; step < 64; step++) {
        let rest = left - t;
        if (rest <= 0.0) {
            break;
        }
        let root = rain_cbrt_square(w);
        let out = drain * w * root;
        if (out > 1000.0 * abs(net) || step == 63) {
            let h = select(min(rest, 0.88 / max(drain * root, 1e-30)), rest, step == 63);
            let half = max(w + 0.5 * net * h, 0.0);
            let x = 1.0 + 2.0 / 3.0 * drain * h * rain_cbrt_square(half);
            w = max(half / (x * sqrt(x)) + 0.5 * net * h, 0.0);
            t += h;
            continue;
        }
        if (net > 0.0 && abs(w - balance) <= 0.01 * balance) {
            return vec2<f32>(left, balance + (w - balance) * exp(-5.0 / 3.0 * net / balance * rest));
        }
        if (net < 0.0 && out <= -net) {
            let ends = rain_film_slowness(0.11270167 * w, net, drain) + rain_film_slowness(0.88729835 * w, net, drain);
            let gone = w / 18.0 * (5.0 * ends + 8.0 * rain_film_slowness(0.5 * w, net, drain));
            if (gone <= rest) {
                return vec2<f32>(t + gone, 0.0);
            }
        }
        let most = max(w, min(balance, w + max(net, 0.0) * rest));
        let h = min(rest, 0.4 / max(5.0 / 3.0 * drain * rain_cbrt_square(most), 1e-12));
        let first = rain_film_rate(w, net, drain);
        let second = rain_film_rate(w + 0.5 * h * first, net, drain);
        let third = rain_film_rate(w + 0.5 * h * second, net, drain);
        let last = rain_film_rate(w + h * third, net, drain);
        w = max(w + h / 6.0 * (first + 2.0 * second + 2.0 * third + last), 0.0);
        t += h;
    }
    return vec2<f32>(left, w);
}

// Water of a texel (x: pores mm, y: film mm, z: soil clock s) after `time` s under constant rain and evaporation, mm/s.
// Error: 1e-3 in an interval of up to a minute, as on the CPU; 1e-5 between the two.
fn rain_column(start: vec3<f32>, rules: ColumnRules, rain: f32, evaporation: f32, time: f32) -> vec3<f32> {
    let supply = rain - evaporation;
    let capacity = rules.capacity;
    let brim = rules.texture;
    let permeable = rules.soil + rules.dry_soil > 0.0;
    var left = time;
    var film = start.y + max(start.x - capacity, 0.0);
    var pores = min(start.x, capacity);
    var tau = start.z;
    let thirst = min(film, capacity - pores);
    pores = select(pores + thirst, capacity, thirst < film);
    film -= thirst;
    var ponding = false;
    for (var piece = 0; piece < 64; piece++) {
        if (left <= 0.0) {
            break;
        }
        if (film <= 0.0 && (pores < capacity || supply <= 0.0)) {
            var used = left;
            if (supply > 0.0) {
                let to_full = (capacity - pores) / supply;
                used = min(to_full, left);
                pores = select(pores + supply * used, capacity, to_full <= left);
            } else {
                pores = max(pores + supply * used, 0.0);
            }
            if (permeable) {
                tau = rain_soil_recovered(rules, tau, used);
            }
            left -= used;
            continue;
        }
        var h = left;
        var soaked = 0.0;
        if (permeable) {
            h = min(left, max(0.03 / rules.soil_decay, left / f32(64 - piece)));
            let most = rain_soil_capacity(rules, tau);
            if (film <= 0.0 && !ponding && most > supply) {
                var ponds = tau;
                var until = 3e38;
                if (supply > rules.soil) {
                    ponds = min(max(-log((supply - rules.soil) / rules.dry_soil) / rules.soil_decay, tau), 30.0 / rules.soil_decay);
                    until = rain_soil_depth(rules, tau, ponds - tau) / supply;
                }
                if (until <= h) {
                    tau = ponds;
                    ponding = true;
                    left -= until;
                } else {
                    var t = supply * h / most;
                    t += (supply * h - rain_soil_depth(rules, tau, t)) / rain_soil_capacity(rules, tau + t);
                    tau = rain_soil_clock(rules, tau, t);
                    left -= h;
                }
                continue;
            }
            soaked = rain_soil_depth(rules, tau, h) / h;
        }
        let net = supply - soaked;
        var used = h;
        if (film > brim || (film == brim && net >= 0.0)) {
            let flow = rain_film_flow(film - brim, net, rules.drain, h);
            used = flow.x;
            film = brim + flow.y;
        } else if (net > 0.0) {
            var to_brim = (brim - film) / net;
            if (permeable && to_brim < h) {
                to_brim += (brim - film - supply * to_brim + rain_soil_depth(rules, tau, to_brim)) / net;
            }
            used = min(to_brim, h);
            film = select(film + net * used, brim, to_brim <= h);
        } else if (net < 0.0) {
            var to_empty = film / -net;
            if (permeable && to_empty < h) {
                to_empty -= (film + supply * to_empty - rain_soil_depth(rules, tau, to_empty)) / net;
            }
            used = min(to_empty, h);
            film = select(film + net * used, 0.0, to_empty <= h);
        }
        if (permeable) {
            tau = rain_soil_clock(rules, tau, used);
        }
        left -= used;
    }
    return vec3<f32>(pores, film, tau);
}
