//! A Bevy app with a real renderer and no window, stepped by hand.

use std::time::Duration;

use bevy::app::{PluginGroupBuilder, PluginsState};
use bevy::asset::{AssetPlugin, UnapprovedPathMode};
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::renderer::{RenderAdapterInfo, RenderDevice};
use bevy::render::settings::{InstanceFlags, RenderCreation, WgpuSettings};
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;

use super::run::RunError;

/// `DefaultPlugins` for a headless run: no window, pipelines compiled before the frame that needs them, assets read
/// from wherever the scenario says.
#[must_use]
pub fn plugins() -> PluginGroupBuilder {
    DefaultPlugins
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            synchronous_pipeline_compilation: true,
            render_creation: RenderCreation::Automatic(Box::new(settings())),
            ..default()
        })
        .set(AssetPlugin {
            file_path: "/".into(),
            unapproved_path_mode: UnapprovedPathMode::Allow,
            ..default()
        })
        .set(LogPlugin {
            filter: "error,bevy_gltf=error".into(),
            ..default()
        })
}

/// Bevy's settings without debug information in shaders, unless `WGPU_DEBUG` asks for it: finding the line of every
/// expression takes a quarter of an app's start.
fn settings() -> WgpuSettings {
    let mut settings = WgpuSettings::default();
    settings.instance_flags = settings.instance_flags.difference(InstanceFlags::DEBUG).with_env();
    settings
}

/// Whether a graphics adapter can be had at all; asked before an app is built, because Bevy panics without one.
///
/// # Errors
/// [`RunError::NoAdapter`] with what to install.
pub fn require_adapter() -> Result<String, RunError> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = bevy::tasks::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
    adapter.map(|a| a.get_info().name).map_err(|_| RunError::NoAdapter)
}

/// What `App::run` does before the first update; needed when `update` is called by hand.
pub fn finish(app: &mut App) {
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
    // A leap between two captures is one update: virtual time must follow it whole.
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(Duration::MAX);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
}

/// One update that advances the clock by `time`.
///
/// # Errors
/// When the renderer gave up (a validation error, a lost device): it only writes `AppExit` and goes on with frozen
/// pictures, so every step looks for it.
pub fn step(app: &mut App, time: Duration) -> Result<(), RunError> {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(time));
    app.update();
    wait_for_gpu(app)?;
    match app.should_exit() {
        None => Ok(()),
        Some(_) => Err(RunError::Renderer(
            "the renderer stopped; its error is in the log".into(),
        )),
    }
}

/// Blocks until the GPU has done everything submitted so far.
fn wait_for_gpu(app: &App) -> Result<(), RunError> {
    let device = app.world().resource::<RenderDevice>();
    device
        .wgpu_device()
        .poll(wgpu::PollType::wait_indefinitely())
        .map(|_| ())
        .map_err(|e| RunError::Renderer(e.to_string()))
}

/// Name of the adapter in use.
#[must_use]
pub fn adapter_name(app: &App) -> String {
    match app.world().get_resource::<RenderAdapterInfo>() {
        Some(info) => format!("{} ({}, {})", info.name, info.driver, info.driver_info),
        None => "unknown".into(),
    }
}
