#pragma once
/// From a picture's light to light without noise, channel by channel.
#include "host/denoise/denoiser.h"
#include "host/image/film_channels.h"
#include <functional>

namespace pointgi {

/// The names of what denoise_picture() adds: R, G and B as they were rendered.
const std::vector<ChannelName>& noisy_channels();

/// Scalars a pixel that denoise_picture() holds beside the picture, at most.
constexpr std::size_t denoise_scalars = 24;

/// Denoises the light in some rows of a picture: Direct, Diffuse, Specular and Caustic, as many as there are, each by
/// itself and guided by Denoise.Albedo and Denoise.N. Pixels of Direct keep what was rendered by the share of
/// Denoise.Emission, so that lamps and sky stay sharp. Then R, G and B are the sum of these lights, and
/// noisy_channels(), the last of `channels`, hold what R, G and B were. All other channels stay. Finite everywhere
/// where the sum fits in a float. `progress`: share done, 0..1. Throws Error as Denoiser::filter(), and leaves R, G, B
/// and the light as rendered then.
void denoise_picture(const Denoiser& denoiser, const std::vector<ChannelName>& channels, Band& rows,
                     const std::function<void(double)>& progress);

} // namespace pointgi
