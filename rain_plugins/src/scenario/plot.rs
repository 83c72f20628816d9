//! The timeline plot: stacked panels on one time axis.

use image::RgbImage;
use plotters::coord::Shift;
use plotters::prelude::*;
use thiserror::Error;

use super::font;
use super::timeline::{Series, Timeline};

/// A plot could not be drawn.
#[derive(Debug, Error)]
pub enum PlotError {
    /// The picture is too small or too large for its panels.
    #[error("plot of {width} x {height} pixels, allowed: 320 to 8192 by 240 to 8192")]
    Size {
        /// Width.
        width: u32,
        /// Height.
        height: u32,
    },
    /// There is nothing to draw against.
    #[error("a timeline with {0} times cannot be plotted, allowed: 2 or more, finite and rising")]
    Times(usize),
    /// The built-in font is broken, or the plotter failed.
    #[error("plotter: {0}")]
    Plotter(String),
}

const INK: RGBColor = RGBColor(45, 52, 61);
const FAINT: RGBColor = RGBColor(225, 229, 234);
const CAPTURE: RGBColor = RGBColor(170, 178, 188);
const RAIN: RGBColor = RGBColor(37, 99, 176);
/// Colours that differ in lightness too, so that they can be told apart without colour vision (Okabe & Ito 2008).
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(150, 150, 60),
];

/// Draws intensity, wetness, water level and budget, one panel each where there are values.
///
/// # Errors
/// For a size out of 320…8192 × 240…8192 pixels, and for a record with fewer than two times or with times that do not rise.
pub fn timeline(title: &str, record: &Timeline, size: [u32; 2]) -> Result<RgbImage, PlotError> {
    let [width, height] = size;
    if !(320..=8192).contains(&width) || !(240..=8192).contains(&height) {
        return Err(PlotError::Size { width, height });
    }
    let times = &record.times_s;
    if times.len() < 2 || !times.iter().all(|t| t.is_finite()) || times.windows(2).any(|w| w[0] >= w[1]) {
        return Err(PlotError::Times(times.len()));
    }
    if !font::ready() {
        return Err(PlotError::Plotter("the built-in font is broken".into()));
    }
    let mut pixels = vec![0; width as usize * height as usize * 3];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, size.into()).into_drawing_area();
        draw(&area, title, record, size).map_err(|e| PlotError::Plotter(e.to_string()))?;
        area.present().map_err(|e| PlotError::Plotter(e.to_string()))?;
    }
    RgbImage::from_raw(width, height, pixels).ok_or(PlotError::Size { width, height })
}

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

struct Panel<'a> {
    label: &'static str,
    series: Vec<(&'a str, &'a [f64])>,
    /// Top of the axis, where it does not follow the values.
    top: Option<f64>,
    filled: bool,
}

fn draw(area: &Area, title: &str, record: &Timeline, [width, height]: [u32; 2]) -> Drawn {
    area.fill(&WHITE)?;
    // Text and spacing follow the picture's size.
    let unit = (f64::from(width.min(height * 3 / 2)) / 1200.0).clamp(0.45, 3.0);
    let px = |v: f64| (v * unit).round() as i32;
    let text = |size: f64, colour: RGBColor| (font::FAMILY, size * unit).into_font().color(&colour);
    let heading = px(52.0);
    area.draw_text(title, &text(28.0, INK), (px(24.0), px(14.0)))?;
    let (divisor, time_unit) = time_unit(record.times_s[record.times_s.len() - 1]);
    let start = record.times_s[0] / divisor;
    let end = record.times_s[record.times_s.len() - 1] / divisor;

    let all = |series: &'_ [Series]| -> Vec<(String, Vec<f64>)> {
        series.iter().map(|s| (s.name.clone(), s.values.clone())).collect()
    };
    let intensity = [("rain".to_owned(), record.intensity_mm_h.clone())];
    let (wetness, level, budget) = (
        all(&record.wetness),
        all(&record.water_level_mm),
        all(&record.budget_mm),
    );
    let panels: Vec<Panel> = [
        ("intensity, mm/h", &intensity[..], None, true),
        ("wetness, 0 to 1", &wetness[..], Some(1.0), false),
        ("water level, mm", &level[..], None, false),
        ("budget, mm", &budget[..], None, false),
    ]
    .into_iter()
    .map(|(label, series, top, filled)| {
        let series = series
            .iter()
            .filter(|(_, values)| values.len() == record.times_s.len())
            .map(|(name, values)| (name.as_str(), values.as_slice()))
            .collect();
        Panel {
            label,
            series,
            top,
            filled,
        }
    })
    .filter(|p| !p.series.is_empty())
    .collect();

    let foot = px(40.0);
    let names = px(150.0);
    let body = area.clone().margin(heading, px(12.0), px(14.0), px(10.0));
    let (_, body_height) = body.dim_in_pixel();
    let count = panels.len().max(1) as i32;
    let each = (body_height as i32 - foot) / count;
    let cuts: Vec<i32> = (1..count).map(|i| i * each).collect();
    let areas = body.split_by_breakpoints::<i32, i32, _, _>(&[], &cuts);
    for (i, (panel, area)) in panels.iter().zip(&areas).enumerate() {
        let last = i + 1 == panels.len();
        let finite = panel
            .series
            .iter()
            .flat_map(|(_, v)| v.iter().copied())
            .filter(|v| v.is_finite());
        let (low, high) = finite.fold((0.0, 0.0), |(low, high): (f64, f64), v| (low.min(v), high.max(v)));
        // A flat zero line still gets an axis.
        let high = panel.top.unwrap_or(if high > low { high * 1.06 } else { low + 1.0 });
        let low = if low < 0.0 { low * 1.06 } else { 0.0 };
        let mut chart = ChartBuilder::on(area)
            .margin_top(px(8.0))
            .margin_bottom(px(4.0))
            .margin_right(names)
            .set_label_area_size(LabelAreaPosition::Left, px(92.0))
            .set_label_area_size(LabelAreaPosition::Bottom, if last { foot } else { 0 })
            .build_cartesian_2d(start..end, low..high)?;
        let x_label = if last {
            format!("time, {time_unit}")
        } else {
            String::new()
        };
        let number = |v: &f64| short(*v);
        let mut mesh = chart.configure_mesh();
        mesh.bold_line_style(FAINT)
            .light_line_style(TRANSPARENT)
            .axis_style(INK)
            .x_labels(12)
            .y_labels(5)
            .x_label_formatter(&number)
            .y_label_formatter(&number)
            .label_style(text(15.0, INK))
            .axis_desc_style(text(17.0, INK))
            .y_desc(panel.label);
        if last {
            mesh.x_desc(&x_label);
        }
        mesh.draw()?;
        for capture in &record.captures_s {
            let x = capture / divisor;
            if (start..=end).contains(&x) {
                chart.draw_series(DashedLineSeries::new(
                    [(x, low), (x, high)],
                    px(3.0).max(1),
                    px(4.0).max(1),
                    CAPTURE.into(),
                ))?;
            }
        }
        for (k, (name, values)) in panel.series.iter().enumerate() {
            let colour = if panel.filled { RAIN } else { COLOURS[k % COLOURS.len()] };
            let points = thinned(&record.times_s, values, divisor, width as usize);
            if panel.filled {
                chart.draw_series(AreaSeries::new(points.iter().copied(), 0.0, colour.mix(0.18)))?;
            }
            let style = colour.stroke_width(px(2.0).max(1) as u32);
            // A gap in the values is a gap in the line.
            for run in points.split(|(_, v)| !v.is_finite()).filter(|r| !r.is_empty()) {
                chart.draw_series(LineSeries::new(run.iter().copied(), style))?;
            }
            // Names stand beside the panel, where they cover no line; what does not fit below the panel is left out.
            let line_height = px(21.0);
            let y = px(20.0) + k as i32 * line_height;
            let (wide, high) = area.dim_in_pixel();
            if y + line_height < high as i32 {
                let x = wide as i32 - names + px(14.0);
                area.draw(&PathElement::new([(x, y), (x + px(20.0), y)], style))?;
                area.draw_text(name, &text(15.0, INK), (x + px(27.0), y - px(9.0)))?;
            }
        }
    }
    let mut note = format!("{} records", record.times_s.len());
    if !record.captures_s.is_empty() {
        note = format!("dashed: captures ({})   {note}", record.captures_s.len());
    }
    let style = text(15.0, CAPTURE);
    let (note_width, _) = area.estimate_text_size(&note, &style)?;
    area.draw_text(&note, &style, (width as i32 - px(20.0) - note_width as i32, px(24.0)))?;
    Ok(())
}

/// Divisor and name of the unit that gives this span readable numbers.
fn time_unit(span_s: f64) -> (f64, &'static str) {
    match span_s {
        s if s <= 300.0 => (1.0, "s"),
        s if s <= 3.0 * 3600.0 => (60.0, "min"),
        s if s <= 3.0 * 86_400.0 => (3600.0, "h"),
        _ => (86_400.0, "days"),
    }
}

fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" || (text == "0" && value != 0.0) {
        format!("{value:.1e}")
    } else {
        text.to_owned()
    }
}

/// Least and greatest value of every half pixel column, in order: no peak is lost, and no more is drawn than can be seen.
fn thinned(times: &[f64], values: &[f64], divisor: f64, width: usize) -> Vec<(f64, f64)> {
    let point = |i: usize| (times[i] / divisor, values[i]);
    let bucket = times.len().div_ceil(width * 2).max(1);
    if bucket < 3 {
        return (0..times.len()).map(point).collect();
    }
    let mut points = vec![point(0)];
    for start in (0..times.len()).step_by(bucket) {
        let range = start..(start + bucket).min(times.len());
        let least = range
            .clone()
            .min_by(|a, b| values[*a].total_cmp(&values[*b]))
            .unwrap_or(start);
        let greatest = range.max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(start);
        points.push(point(least.min(greatest)));
        points.push(point(least.max(greatest)));
    }
    points.push(point(times.len() - 1));
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn storm(n: u32) -> Timeline {
        let times: Vec<f64> = (0..n).map(|i| f64::from(i) * 3600.0 / f64::from(n - 1)).collect();
        let of = |f: &dyn Fn(f64) -> f64| times.iter().map(|t| f(*t)).collect::<Vec<_>>();
        let rate = |t: f64| 40.0 * (-((t - 1500.0) / 500.0_f64).powi(2)).exp();
        let series = |name: &str, f: &dyn Fn(f64) -> f64| Series {
            name: name.into(),
            values: of(f),
        };
        Timeline {
            intensity_mm_h: of(&rate),
            wetness: vec![
                series("asphalt", &|t| 1.0 / (1.0 + (-(t - 700.0) / 60.0).exp())),
                series("concrete", &|t| 1.0 / (1.0 + (-(t - 900.0) / 90.0).exp())),
                series("stone", &|t| 1.0 / (1.0 + (-(t - 500.0) / 40.0).exp())),
            ],
            water_level_mm: vec![
                series("road", &|t| 1.4 * (-((t - 1700.0) / 600.0_f64).powi(2)).exp()),
                series("canopy store", &|t| 0.8 * (1.0 - (-t / 600.0).exp())),
            ],
            budget_mm: vec![
                series("rain", &|t| 9.0 / (1.0 + (-(t - 1500.0) / 250.0).exp())),
                series("basins", &|t| 3.0 / (1.0 + (-(t - 1900.0) / 250.0).exp())),
                series("drained", &|t| 4.0 / (1.0 + (-(t - 2100.0) / 250.0).exp())),
                series("evaporated", &|t| 0.2 * t / 3600.0),
            ],
            captures_s: (1..13).map(|i| f64::from(i) * 290.0).collect(),
            times_s: times,
        }
    }

    #[test]
    fn a_storm_is_plotted() {
        for size in [[1280, 960], [640, 480], [2400, 1600]] {
            let picture = timeline("storm: 1 h, seed 7", &storm(500), size).unwrap();
            assert_eq!([picture.width(), picture.height()], size);
            let colour = |c: RGBColor| picture.pixels().filter(|p| p.0 == [c.0, c.1, c.2]).count();
            let all = (size[0] * size[1]) as usize;
            assert!(colour(WHITE) > all / 2 && colour(WHITE) < all * 97 / 100);
            assert!(colour(RAIN) > size[0] as usize / 4 && colour(COLOURS[1]) > size[0] as usize / 4);
            assert!(colour(FAINT) > size[0] as usize);
            if let Some(folder) = std::env::var_os("RAIN_LOOK") {
                picture
                    .save(std::path::Path::new(&folder).join(format!("timeline_{}.png", size[0])))
                    .unwrap();
            }
        }
    }

    #[test]
    fn values_move_the_line() {
        let wet = timeline("t", &storm(300), [800, 600]).unwrap();
        let mut dry = storm(300);
        dry.intensity_mm_h.fill(0.0);
        assert_ne!(wet, timeline("t", &dry, [800, 600]).unwrap());
        dry.wetness[0].values[40..60].fill(f64::NAN);
        assert!(timeline("t", &dry, [800, 600]).is_ok());
    }

    #[test]
    fn no_peak_is_lost() {
        let mut record = storm(50_000);
        record.intensity_mm_h[20_001] = 400.0;
        let points = thinned(&record.times_s, &record.intensity_mm_h, 1.0, 800);
        assert!(points.len() < 4000 && points.iter().any(|p| p.1 == 400.0));
        assert!(points.windows(2).all(|w| w[0].0 <= w[1].0));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(matches!(
            timeline("", &storm(9), [100, 100]),
            Err(PlotError::Size { .. })
        ));
        assert!(matches!(
            timeline("", &Timeline::default(), [800, 600]),
            Err(PlotError::Times(0))
        ));
        let mut record = storm(9);
        record.times_s[4] = record.times_s[3];
        assert!(matches!(timeline("", &record, [800, 600]), Err(PlotError::Times(9))));
    }

    #[test]
    fn units_of_time() {
        assert_eq!(
            [60.0, 600.0, 36_000.0, 1e6].map(|s| time_unit(s).1),
            ["s", "min", "h", "days"]
        );
        assert_eq!([0.0, 0.5, 12.0, 1e-6].map(short), ["0", "0.5", "12", "1.0e-6"]);
    }
}
