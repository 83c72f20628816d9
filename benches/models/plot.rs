//! The plane of error against time.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};

use crate::study::Study;
use crate::table::duration;
use crate::timing::Time;

const FAMILY: &str = "rain";
const INK: RGBColor = RGBColor(45, 52, 61);
const FAINT: RGBColor = RGBColor(225, 229, 234);
const DEFAULT: RGBColor = RGBColor(213, 94, 0);
const OTHER: RGBColor = RGBColor(0, 114, 178);

/// Pixels: width of the picture and of its plane, least height.
const WIDTH: u32 = 1040;
const PLANE: u32 = 600;
const HEIGHT: u32 = 520;
/// Pixels of one entry in the list of names, and of the space above it.
const ENTRY: u32 = 40;
const LIST_TOP: u32 = 50;

/// A time that is a power of ten, with a fitting unit.
fn decade(ns: f64) -> String {
    let (value, unit) = match ns {
        ns if ns < 0.99 => (ns * 1e3, "ps"),
        ns if ns < 0.99e3 => (ns, "ns"),
        ns if ns < 0.99e6 => (ns * 1e-3, "µs"),
        ns if ns < 0.99e9 => (ns * 1e-6, "ms"),
        ns => (ns * 1e-9, "s"),
    };
    format!("{value:.0} {unit}")
}

/// Draws the study: numbered points on logarithmic axes, the default in its own colour over the others, and the list of
/// names.
///
/// An error of 0 is drawn a decade under the smallest other one.
///
/// # Errors
/// When the picture cannot be drawn or written; the message says why.
pub fn draw(study: &Study, times: &[Time], path: &Path) -> Result<(), String> {
    register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
        .map_err(|_| "the built-in font is broken".to_owned())?;
    let smallest = study
        .variants
        .iter()
        .map(|variant| variant.error)
        .filter(|error| *error > 0.0)
        .fold(f64::INFINITY, f64::min);
    let floor = if smallest.is_finite() { smallest * 0.1 } else { 1e-16 };
    let points: Vec<(f64, f64)> = study
        .variants
        .iter()
        .zip(times)
        .map(|(variant, time)| (time.median_ns, variant.error.max(floor)))
        .collect();
    if points
        .iter()
        .any(|(x, y)| !x.is_finite() || !y.is_finite() || *x <= 0.0)
    {
        return Err(format!("{}: a time or an error is not finite", study.name));
    }
    // Whole decades: a logarithmic axis that is shorter crowds its labels.
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = values.fold((f64::INFINITY, 0_f64), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = ((low * 0.8).log10().floor(), (high * 1.25).log10().ceil());
        (10_f64.powf(low)..10_f64.powf(high), (high - low) as usize)
    };
    let (x, x_decades) = range(&mut points.iter().map(|p| p.0));
    let (y, y_decades) = range(&mut points.iter().map(|p| p.1));
    let size = (WIDTH, HEIGHT.max(LIST_TOP + ENTRY * (points.len() as u32 + 1)));
    let mut pixels = vec![0; 3 * size.0 as usize * size.1 as usize];
    let inner = |pixels: &mut [u8]| -> Result<(), Box<dyn std::error::Error>> {
        let root = BitMapBackend::with_buffer(pixels, size).into_drawing_area();
        root.fill(&WHITE)?;
        let (left, right) = root.split_horizontally(PLANE);
        let mut chart = ChartBuilder::on(&left)
            .caption(study.title, (FAMILY, 20, &INK))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(74)
            .build_cartesian_2d(x.log_scale(), y.log_scale())?;
        chart
            .configure_mesh()
            .bold_line_style(FAINT)
            .light_line_style(WHITE)
            .axis_style(INK)
            .label_style((FAMILY, 14, &INK))
            .x_desc(format!("time per {}", study.unit))
            .y_desc(study.norm)
            .x_labels(x_decades.min(6) + 1)
            .y_labels(y_decades.min(9) + 1)
            .x_label_formatter(&|ns| decade(*ns))
            .y_label_formatter(&|error| format!("{error:.0e}"))
            .draw()?;
        let centred = Pos::new(HPos::Center, VPos::Center);
        // The default over those that it may lie on.
        let mut order: Vec<_> = study.variants.iter().zip(&points).enumerate().collect();
        order.sort_by_key(|(_, (variant, _))| variant.default);
        for (index, (variant, point)) in order {
            let colour = if variant.default { DEFAULT } else { OTHER };
            let place = chart.backend_coord(point);
            root.draw(&Circle::new(place, 10, colour.filled()))?;
            let style = (FAMILY, 14, &WHITE).into_text_style(&root).pos(centred);
            root.draw(&Text::new((index + 1).to_string(), place, style))?;
        }
        for (index, (variant, time)) in study.variants.iter().zip(times).enumerate() {
            let top = (LIST_TOP + ENTRY * index as u32) as i32;
            let colour = if variant.default { DEFAULT } else { OTHER };
            let mark = if variant.default { " (default)" } else { "" };
            let style = (FAMILY, 15, &colour).into_text_style(&right);
            right.draw(&Text::new(
                format!("{}  {}{mark}", index + 1, variant.name),
                (8, top),
                style,
            ))?;
            let style = (FAMILY, 13, &INK).into_text_style(&right);
            let figures = format!("{}, error {:.1e}", duration(time.median_ns), variant.error);
            right.draw(&Text::new(figures, (28, top + 17), style))?;
        }
        root.present()?;
        Ok(())
    };
    inner(&mut pixels).map_err(|error| format!("{}: {error}", study.name))?;
    image::save_buffer(path, &pixels, size.0, size.1, image::ColorType::Rgb8)
        .map_err(|error| format!("{}: {error}", path.display()))
}
