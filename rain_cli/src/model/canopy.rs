//! Rain through a tree's crown.

use rain_core::canopy::{CanopyKind, CanopyProperties, canopy_shower};
use rain_core::weather::MAX_INTERVAL_S;

use super::key::{Key, returns};
use super::rainfall::RAIN_MM_H;
use super::{Model, ModelError, Output, ReadFile, Values};

pub(super) const MODELS: &[&Model] = &[&CANOPY];

static CANOPY: Model = Model {
    name: "canopy",
    what: "store, drip and stemflow of a dry crown under constant rain (Watanabe & Mizutani 1996, state form)",
    keys: &[
        Key::number("lai", [0.0, 20.0], "", "leaf area index"),
        Key::choice("kind", &["broadleaf", "needle"], "kind of leaves"),
        Key::number("intensity_mm_h", RAIN_MM_H, "mm/h", "rain in the open field"),
        Key::number("duration_s", [0.0, MAX_INTERVAL_S], "s", "duration of the rain"),
        Key::number("evaporation_mm_h", [0.0, 1e4], "mm/h", "evaporation from wet leaves").or("0"),
        Key::number(
            "max_drip_fraction",
            [0.0, 1.0],
            "",
            "largest share of the intercepted rain that drips",
        )
        .or("0.8"),
        Key::number(
            "gap_extinction",
            [0.0, 5.0],
            "",
            "κ: a share e^(−κ LAI) falls through gaps",
        )
        .or("0.5"),
    ],
    returns: &[
        returns("capacity_mm", "mm", "water that the leaves hold, S"),
        returns("saturation_time_s", "s", "7200 S/intensity"),
        returns("storage_mm", "mm", "water on the leaves at the end"),
        returns("free_throughfall_mm", "mm", "through gaps"),
        returns("drip_mm", "mm", "dripped from leaves"),
        returns("stemflow_mm", "mm", "down the trunk"),
        returns("throughfall_mm", "mm", "free throughfall and drip"),
        returns("evaporated_mm", "mm", "evaporated from leaves"),
        returns("fallen_mm", "mm", "throughfall + stemflow + storage + evaporated"),
        returns(
            "drip_fraction",
            "",
            "share of the intercepted rain that drips at the end",
        ),
    ],
    example: &["lai=4", "intensity_mm_h=10", "duration_s=600"],
    run: canopy,
};

fn canopy(values: &Values, _: ReadFile<'_>) -> Result<Output, ModelError> {
    let properties = CanopyProperties {
        kind: match values.word("kind") {
            "needle" => CanopyKind::Needle,
            _ => CanopyKind::Broadleaf,
        },
        leaf_area_index: values.number("lai"),
        gap_extinction: values.number("gap_extinction"),
        max_drip_fraction: values.number("max_drip_fraction"),
    };
    let shower = canopy_shower(
        properties,
        values.number("intensity_mm_h"),
        values.number("duration_s"),
        values.number("evaporation_mm_h"),
    )?;
    let fluxes = shower.fluxes;
    Ok(Output::new([
        ("capacity_mm", shower.capacity_mm),
        // It rains, so there is one.
        ("saturation_time_s", shower.saturation_time_s.unwrap_or(f64::INFINITY)),
        ("storage_mm", shower.storage_mm),
        ("free_throughfall_mm", fluxes.free_throughfall_mm),
        ("drip_mm", fluxes.drip_mm),
        ("stemflow_mm", fluxes.stemflow_mm),
        ("throughfall_mm", fluxes.throughfall_mm()),
        ("evaporated_mm", fluxes.evaporated_mm),
        ("fallen_mm", shower.fallen_mm()),
        ("drip_fraction", shower.drip_fraction),
    ]))
}
