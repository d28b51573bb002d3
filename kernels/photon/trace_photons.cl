/* Photons from the lights by way of specular surfaces to diffuse ones, LS+D, or where FROM_SURFACES from diffuse surfaces,
 * LD+S+D (method.md section 5).
 * NDRange: 1-D, a work-item a photon, padded; work-item i follows photon first + i, for i < count, and writes flights[i].
 * A photon depends on its number alone, not on how they are cut into launches. batches, in the order of their photons,
 * batch_count >= 1 of them; leaf_of[k]: leaf of point k. Where EQUAL_POWER or FROM_SURFACES, any leaf will do for a
 * photon, else only its own. */
#include "photon/emit.cl"
#include "materials/materials.cl"
#ifdef FROM_SURFACES
#include "photon/emit_from_surfaces.cl"
#endif

#define DIMENSION_CHOICE 3u
#define DIMENSION_SCATTER 4u

/* The batch of a photon. */
static inline uint batch_of(const __global EmissionBatch* batches, uint batch_count, uint photon) {
  uint low = 0u, high = batch_count - 1u;
  while (low < high) {
    const uint middle = (low + high + 1u) / 2u;
    if (batches[middle].first <= photon)
      low = middle;
    else
      high = middle - 1u;
  }
  return low;
}

static inline uint direction_bits(float component, uint shift) {
  return ((uint)convert_int_rte(clamp(component, -1.0f, 1.0f) * PHOTON_DIRECTION_SCALE) & 1023u) << shift;
}

static inline void store3(float3 v, __global float* to) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

/* The number of the first ray's bounces: one that looks for light is none. */
#ifdef FROM_SURFACES
#define FIRST_RAY 0xffffffffu
#else
#define FIRST_RAY 0u
#endif

static inline bool is_dark(float3 power) { return !(power.x > 0.0f || power.y > 0.0f || power.z > 0.0f); }

/* How a photon goes on from a surface that it has met; PHOTON_ENDS where it does. A surface that is both takes it or
 * mirrors it at random; one that comes straight from the light is mirrored, as its diffuse
 * part is no caustic. */
static inline uint meet_surface(const Surface* s, const __global Material* materials, float3 direction, SampleId id,
                                uint bounces, Media* media, Scatter* scatter, float3* power) {
  const __global Material* material = materials + s->material;
  const float probability = bounces > 0u ? specular_probability(s, material) : has_flag(material, MATERIAL_SPECULAR) ? 1.0f : 0.0f;
  if (!(random4(id, DIMENSION_CHOICE).x < probability)) {
    *power /= 1.0f - probability;
    return s->front ? PHOTON_STORED : PHOTON_ABSORBED;
  }
  if (!scatter_ray(s, materials, direction, random4(id, DIMENSION_SCATTER).xy, media, scatter))
    return PHOTON_ABSORBED;
  *power *= scatter->weight / probability;
  return is_dark(*power) ? PHOTON_ABSORBED : PHOTON_ENDS;
}

__kernel OWN_VECTORS void trace_photons(POOL_PARAMS, LIGHT_PARAMS, const __global float4* radiance, const __global EmissionBatch* batches,
                            const __global PhotonLeaf* leaves, const __global uint* leaf_splats,
                            const __global uint* leaf_of, __global PhotonFlight* flights, uint batch_count, uint first,
                            uint count) {
  const uint item = get_global_id(0);
  if (item >= count)
    return;
  const __global EmissionBatch* batch = batches + batch_of(batches, batch_count, first + item);
  const PhotonSource from = {{LIGHT_ARGS}, radiance, leaves, leaf_splats};
  SampleId id = {(uint2)(first + item, 0x20000000u), 0u, params->seed, 0u};
#ifdef FROM_SURFACES
  const Emission e = look_for_light(POOL_ARGS, from, batch, first + item - batch->first, id);
#else
  const Emission e = emit_photon(POOL_ARGS, from, batch, first + item - batch->first, id);
#endif
  const uint most = min(params->most_bounces, PHOTON_MOST_BOUNCES);
  float3 power = e.power, emitted = (float3)(0.0f), absorbed = (float3)(0.0f), position = (float3)(0.0f), inward = (float3)(0.0f);
  Ray ray = e.ray;
  OcclusionEnds ends = e.ends;
  Media media = in_air();
  uint end = PHOTON_MISSED, bounces = FIRST_RAY, splat = NO_SPLAT;
  float rays = 0.0f;
#ifdef HAS_TRANSMISSION
  float set_out_in = 0.0f; /* index of what the photon set out in, when it has passed through glass: only then it is known */
#endif
  for (; !is_dark(power); ++bounces) {
    Surface s;
    Scatter scatter;
    const Hit hit = trace_closest_from(POOL_ARGS, ray, ends);
    const bool met = blended_surface(POOL_ARGS, ray, ends, hit, &s, &rays);
#ifdef FROM_SURFACES
    if (bounces == FIRST_RAY) { /* one place traces it, too: the walk stands once in the code */
      if (!met || !s.front)
        break;
      power *= radiance[s.splat].xyz;
      turn_round(&s, &ray, &ends);
      continue;
    }
#endif
    if (!met) {
      end = bounces > 0u ? PHOTON_ESCAPED : PHOTON_MISSED;
      break;
    }
    if (bounces == 0u) {
#if defined(EQUAL_POWER) || defined(FROM_SURFACES)
      if (leaf_of[s.splat] == NO_PHOTON_LEAF)
        break;
#else
      if (leaf_of[s.splat] != batch->leaf)
        break;
#endif
      emitted = power;
    }
    media = media_before(media, &s, materials);
    float3 before = power;
    power *= beer_of(media, materials, s.t);
    position = s.position;
    inward = -s.normal;
    splat = s.splat;
#ifdef HAS_TRANSMISSION
    const float here = ior_of(media, materials);
#endif
    end = meet_surface(&s, materials, ray.direction, id, bounces, &media, &scatter, &power);
    absorbed += before - power;
    if (end != PHOTON_ENDS)
      break;
#ifdef HAS_TRANSMISSION
    /* The power of point lights is that of the light, whatever stands about them; that of surfaces comes of a radiance. */
    if (scatter.through && set_out_in == 0.0f)
      set_out_in = batch->source < SOURCE_ENVIRONMENT ? 1.0f : here;
#endif
    end = PHOTON_CUT;
    if (bounces + 2u > most) /* no diffuse surface may follow */
      break;
    ray = scattered_ray(&s, &scatter, params->step_delta);
    ends = scattered_ends(&s, &scatter, media);
    id.vertex += 1u;
  }
  float radiance_factor = 1.0f;
#ifdef HAS_TRANSMISSION
  if (set_out_in > 0.0f) {
    const float ratio = set_out_in / ior_of(media, materials);
    radiance_factor = ratio * ratio;
  }
#endif
  __global PhotonFlight* flight = flights + item;
  store3(position, flight->position);
  flight->inward = direction_bits(inward.x, 0u) | direction_bits(inward.y, 10u) | direction_bits(inward.z, 20u);
  store3(end == PHOTON_MISSED ? (float3)(0.0f) : power, flight->power);
  flight->end = end;
  store3(emitted, flight->emitted);
  flight->radiance_factor = radiance_factor;
  store3(absorbed, flight->absorbed);
  flight->splat = splat;
}
