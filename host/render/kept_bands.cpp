#include "host/render/kept_bands.h"

namespace pointgi {

namespace {

void pack_totals(Packer& to, const RenderTotals& t) {
  to << t.eye_rays << t.rays << t.eye_rays_on_splats << t.eye_rays_on_back_faces << t.eye_seconds << t.device_seconds
     << t.of_object << t.lit;
}

void unpack_totals(Unpacker& from, RenderTotals& t) {
  from >> t.eye_rays >> t.rays >> t.eye_rays_on_splats >> t.eye_rays_on_back_faces >> t.eye_seconds >>
      t.device_seconds >> t.of_object >> t.lit;
}

} // namespace

void pack(Packer& to, const FinishedBand& band) {
  to << band.band.first_row << band.band.rows << band.band.width << band.band.values;
  pack_totals(to, band.totals);
}

void unpack(Unpacker& from, FinishedBand& band) {
  from >> band.band.first_row >> band.band.rows >> band.band.width >> band.band.values;
  unpack_totals(from, band.totals);
}

void pack(Packer& to, const BandSums& band) {
  to << band.sums << band.samples << band.eye_seconds << band.device_seconds;
}

void unpack(Unpacker& from, BandSums& band) {
  from >> band.sums >> band.samples >> band.eye_seconds >> band.device_seconds;
}

void add(const RenderTotals& of_rows, RenderTotals& to) {
  for (const auto member : {&RenderTotals::eye_rays, &RenderTotals::rays, &RenderTotals::eye_rays_on_splats,
                            &RenderTotals::eye_rays_on_back_faces})
    to.*member += of_rows.*member;
  to.eye_seconds += of_rows.eye_seconds;
  to.device_seconds += of_rows.device_seconds;
  to.lit = to.lit || of_rows.lit;
  if (to.of_object.size() < of_rows.of_object.size()) to.of_object.resize(of_rows.of_object.size());
  for (std::size_t i = 0; i < of_rows.of_object.size(); ++i) {
    to.of_object[i].on_splats += of_rows.of_object[i].on_splats;
    to.of_object[i].on_backs += of_rows.of_object[i].on_backs;
  }
}

} // namespace pointgi
