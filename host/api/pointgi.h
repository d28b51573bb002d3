#pragma once
/// Global illumination of point clouds: the header that programs include.
///
///   pointgi::Context context;                                  // a device
///   pointgi::Prepared prepared(context, pointgi::Scene::from_file("room.toml"));
///   pointgi::Light light(prepared);                            // solved once for all views
///   pointgi::Film(light).write_png("room.png");
///
/// Errors are thrown as pointgi::Error, which says what was wrong and what to do, or as std::bad_alloc and
/// std::length_error for what fits into no memory.
#include "host/api/film.h"
#include "host/error.h"

namespace pointgi {

using api::Camera;
using api::Context;
using api::Film;
using api::FilmOptions;
using api::Keys;
using api::Light;
using api::LightOptions;
using api::Points;
using api::Prepared;
using api::Scene;
using api::Value;

} // namespace pointgi
