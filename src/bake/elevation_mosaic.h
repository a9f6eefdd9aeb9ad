// Elevation sources as one surface: layers in order of preference, each faded into the next, at last sea level.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/elevation.h"
#include "bake/elevation_layer.h"

namespace eye {

struct MosaicOptions {
  size_t cacheBytes = size_t{1} << 30;
  HeightCorrection correctionM;
};

// Thread: any number at once.
class ElevationMosaic final : public ElevationSurface {
 public:
  // Each source a file, archive or folder, in order of preference; inside one source finer files come first. Reads
  // every file once, so that what cannot be read is found before the bake.
  static Result<std::unique_ptr<ElevationMosaic>> open(const std::vector<std::string>& sources,
                                                       const MosaicOptions& options = {});
  ~ElevationMosaic() override;

  double heightM(double latDeg, double lonDeg) const override;
  void heightsM(const std::vector<LatLon>& points, std::vector<double>& heightsM) const override;
  PostLines postLines(const TileBounds& region) const override;
  double finestSpacingDeg(const TileBounds& region) const override;
  std::vector<double> spacingsDeg(const TileBounds& region) const override;
  TileBounds dataBounds() const override;

  // Of all layers.
  std::vector<double> spacingsDeg() const;
  const std::vector<ElevationLayer>& layers() const;
  // What went wrong while reading heights since the start; heights read after that are not to be trusted.
  std::optional<Error> readError() const;

 private:
  struct Impl;
  explicit ElevationMosaic(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace eye
