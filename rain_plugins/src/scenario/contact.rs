//! The contact sheet: all captures small on one picture, each with a caption.

use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};
use plotters::prelude::*;

use super::font;
use super::plot::PlotError;

/// Most pictures on a sheet; of more captures an even selection is shown.
pub const MAX_CELLS: usize = 60;

const BACKGROUND: Rgb<u8> = Rgb([24, 27, 31]);
const CAPTION: RGBColor = RGBColor(226, 230, 235);

/// Collects captures as they come and keeps only their small versions.
#[derive(Debug, Clone)]
pub struct ContactSheet {
    captures: usize,
    columns: u32,
    cell: [u32; 2],
    cells: Vec<(RgbImage, String)>,
}

impl ContactSheet {
    /// For `captures` pictures of `size` pixels (width, height; at least 1 × 1).
    #[must_use]
    pub fn new(captures: usize, size: [u32; 2]) -> Self {
        let shown = captures.clamp(1, MAX_CELLS) as u32;
        let columns = match shown {
            1 => 1,
            2..=4 => 2,
            5..=9 => 3,
            10..=20 => 4,
            _ => 6,
        };
        let [w, h] = size.map(|s| s.max(1));
        // Neither larger than the captures nor so large that the sheet passes 2400 pixels.
        let width = (2400 / columns).min(w).min(960);
        let height = (u64::from(width) * u64::from(h) / u64::from(w)).clamp(1, 2400) as u32;
        Self {
            captures,
            columns,
            cell: [width, height],
            cells: Vec::new(),
        }
    }

    /// Takes capture `index` with the caption [`caption`] or another of one line. Ignored where it is not in the
    /// selection.
    pub fn push(&mut self, index: usize, picture: &RgbImage, caption: impl Into<String>) {
        let shown = self.captures.min(MAX_CELLS);
        // Cell k shows capture k·captures/shown.
        let cell = (index * shown).div_ceil(self.captures.max(1));
        if index >= self.captures || cell * self.captures / shown.max(1) != index {
            return;
        }
        let small = imageops::resize(picture, self.cell[0], self.cell[1], FilterType::Triangle);
        self.cells.push((small, caption.into()));
    }

    /// The sheet. Without any capture it is a single empty cell.
    ///
    /// # Errors
    /// When text cannot be drawn.
    pub fn finish(&self) -> Result<RgbImage, PlotError> {
        if !font::ready() {
            return Err(PlotError::Plotter("the built-in font is broken".into()));
        }
        let [w, h] = self.cell;
        let gap = 8;
        let strip = (w / 16).clamp(22, 34);
        let columns = self.columns;
        let rows = (self.cells.len() as u32).div_ceil(columns).max(1);
        let size = [gap + columns * (w + gap), gap + rows * (h + strip + gap)];
        let mut sheet = RgbImage::from_pixel(size[0], size[1], BACKGROUND);
        let place = |i: usize| {
            let (column, row) = (i as u32 % columns, i as u32 / columns);
            (gap + column * (w + gap), gap + row * (h + strip + gap))
        };
        for (i, (picture, _)) in self.cells.iter().enumerate() {
            let (x, y) = place(i);
            imageops::replace(&mut sheet, picture, i64::from(x), i64::from(y));
        }
        let mut pixels = sheet.into_raw();
        {
            let failed = |e: &dyn std::fmt::Display| PlotError::Plotter(e.to_string());
            let area = BitMapBackend::with_buffer(&mut pixels, size.into()).into_drawing_area();
            let style = (font::FAMILY, f64::from(strip) * 0.72).into_font().color(&CAPTION);
            for (i, (_, caption)) in self.cells.iter().enumerate() {
                let (x, y) = place(i);
                let at = ((x + 4) as i32, (y + h + strip / 7) as i32);
                // A caption wider than its cell would run into the next one.
                let mut text = caption.clone();
                while !text.is_empty() && area.estimate_text_size(&text, &style).map_err(|e| failed(&e))?.0 + 8 > w {
                    text.pop();
                }
                area.draw_text(&text, &style, at).map_err(|e| failed(&e))?;
            }
            area.present().map_err(|e| failed(&e))?;
        }
        RgbImage::from_raw(size[0], size[1], pixels).ok_or(PlotError::Size {
            width: size[0],
            height: size[1],
        })
    }
}

/// The usual caption: index, time and rain rate.
#[must_use]
pub fn caption(index: usize, time_s: f64, intensity_mm_h: f64) -> String {
    let whole = time_s.max(0.0).round() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    let time = if time_s < 60.0 {
        format!("{time_s:.2} s")
    } else if hours == 0 {
        format!("{minutes}:{seconds:02} min")
    } else {
        format!("{hours}:{minutes:02}:{seconds:02} h")
    };
    format!("#{index}   {time}   {intensity_mm_h:.1} mm/h")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(index: u32) -> RgbImage {
        RgbImage::from_fn(320, 180, |x, y| {
            Rgb([(x * 255 / 320) as u8, (y * 255 / 180) as u8, (index * 20) as u8])
        })
    }

    #[test]
    fn every_capture_is_there_with_a_caption() {
        let mut sheet = ContactSheet::new(12, [320, 180]);
        for i in 0..12 {
            sheet.push(
                i as usize,
                &picture(i),
                caption(i as usize, f64::from(i) * 437.5, f64::from(i) * 3.3),
            );
        }
        let image = sheet.finish().unwrap();
        let (cell_w, cell_h) = (320 + 8, 180 + 22 + 8);
        assert_eq!((image.width(), image.height()), (8 + 4 * cell_w, 8 + 3 * cell_h));
        for i in 0..12 {
            let (x, y) = (8 + i % 4 * cell_w, 8 + i / 4 * cell_h);
            assert_eq!(image.get_pixel(x + 160, y + 90).0[2], (i * 20) as u8);
            let text = (0..320).flat_map(|dx| (180..202).map(move |dy| (dx, dy)));
            let bright = text
                .filter(|(dx, dy)| image.get_pixel(x + dx, y + dy).0[0] > 120)
                .count();
            assert!(bright > 40, "caption {i}: {bright} bright pixels");
        }
        if let Some(folder) = std::env::var_os("RAIN_LOOK") {
            image.save(std::path::Path::new(&folder).join("contact.png")).unwrap();
        }
    }

    #[test]
    fn many_captures_are_thinned_evenly() {
        let mut sheet = ContactSheet::new(1000, [64, 36]);
        for i in 0..1000 {
            sheet.push(i, &RgbImage::new(64, 36), i.to_string());
        }
        assert_eq!(sheet.cells.len(), MAX_CELLS);
        let shown: Vec<usize> = sheet.cells.iter().map(|c| c.1.parse().unwrap()).collect();
        assert!(shown[0] == 0 && shown.windows(2).all(|w| (16..=17).contains(&(w[1] - w[0]))));
        assert_eq!(sheet.finish().unwrap().height(), 8 + 10 * (36 + 22 + 8));
    }

    #[test]
    fn sizes_at_the_limits() {
        for size in [[1, 1], [8192, 8192], [8192, 1], [1, 8192]] {
            let mut sheet = ContactSheet::new(1, size);
            sheet.push(0, &RgbImage::new(4, 4), "a caption that is wider than a pixel");
            let image = sheet.finish().unwrap();
            assert!(image.width() <= 2416 && image.height() <= 2460, "{size:?}");
        }
        assert!(ContactSheet::new(0, [10, 10]).finish().is_ok());
    }

    #[test]
    fn captions() {
        assert_eq!(caption(3, 12.5, 25.0), "#3   12.50 s   25.0 mm/h");
        assert_eq!(caption(0, 125.0, 0.04), "#0   2:05 min   0.0 mm/h");
        assert_eq!(caption(11, 3725.0, 7.0), "#11   1:02:05 h   7.0 mm/h");
    }
}
