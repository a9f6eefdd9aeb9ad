#include "bake/elevation_mosaic.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <list>
#include <mutex>

#include <fmt/format.h>

#include "bake/page_cache.h"
#include "raster/find_rasters.h"

namespace eye {

namespace {

// A page that alone makes the surface, and its layer's inner cells: nothing above it, no fade, no pole.
struct PagePatch {
  PageCache::Page page;
  PostLattice lattice;
  int64_t south = 0, north = 0, west = 0, east = 0;  // cells, inclusive
  PageCache::Page refused;                           // the last page that others show through
};

}  // namespace

struct ElevationMosaic::Impl {
  explicit Impl(const MosaicOptions& given) : options(given), cache(given.cacheBytes) {}

  MosaicOptions options;
  std::vector<ElevationLayer> layers;  // in order of preference
  PageCache cache;
  uint64_t serial = 0;  // tells mosaics apart in threads' memories of their last pages
  mutable std::mutex errorMutex;
  std::optional<Error> error;

  HeightBelow heightFrom(size_t layer, double latDeg, double lonDeg);
  const PagePatch* patchAt(double latDeg, double lonDeg, PagePatch& patch);
  PageCache::Page page(size_t layer, int64_t pageRow, int64_t pageColumn);
};

namespace {

std::atomic<uint64_t> nextSerial{1};

// The page a thread used last in each layer: nearly every height falls into the one before's page.
struct LastPages {
  uint64_t serial = 0;
  std::vector<PageCache::Page> pages;
};

// A geoid is a mosaic of its own and takes turns with the terrain's; the list keeps references alive.
LastPages& lastPagesOf(uint64_t serial, size_t layers) {
  thread_local std::list<LastPages> recent;
  for (LastPages& pages : recent) {
    if (pages.serial == serial) return pages;
  }
  constexpr size_t kMosaicsAtOnce = 4;
  if (recent.size() == kMosaicsAtOnce) recent.pop_back();
  recent.push_front({serial, std::vector<PageCache::Page>(layers)});
  return recent.front();
}

bool holds(const ElevationPage& page, int64_t row, int64_t column) {
  return row >= page.south && row < page.south + kPagePosts && column >= page.west && column < page.west + kPagePosts;
}

double bilinear(const std::vector<float>& posts, size_t first, size_t rowPosts, double north, double east) {
  const double southWest = static_cast<double>(posts[first]), southEast = static_cast<double>(posts[first + 1]);
  const double northWest = static_cast<double>(posts[first + rowPosts]);
  const double northEast = static_cast<double>(posts[first + rowPosts + 1]);
  const double south = southWest + (southEast - southWest) * east;
  return south + (northWest + (northEast - northWest) * east - south) * north;
}

}  // namespace

PageCache::Page ElevationMosaic::Impl::page(size_t layer, int64_t pageRow, int64_t pageColumn) {
  const PageId id{static_cast<uint32_t>(layer), static_cast<int32_t>(pageRow), static_cast<int32_t>(pageColumn)};
  return cache.get(id, [&]() -> PageCache::Page {
    const SurfaceBelow below = [&](double latDeg, double lonDeg) { return heightFrom(layer + 1, latDeg, lonDeg); };
    Result<ElevationPage> made = layers[layer].makePage(pageRow, pageColumn, below, options.correctionM);
    if (made) return std::make_shared<const ElevationPage>(std::move(*made));
    const std::lock_guard lock(errorMutex);
    if (!error) error = made.error();
    ElevationPage empty;
    empty.south = pageRow * kPagePosts;
    empty.west = pageColumn * kPagePosts;
    return std::make_shared<const ElevationPage>(std::move(empty));
  });
}

HeightBelow ElevationMosaic::Impl::heightFrom(size_t first, double latDeg, double lonDeg) {
  LastPages& lastPages = lastPagesOf(serial, layers.size());
  double heightM = 0, remaining = 1;
  ElevationLayer::Place place;
  for (size_t i = first; i < layers.size(); ++i) {
    if (!layers[i].locate(latDeg, lonDeg, place)) continue;
    PageCache::Page& last = lastPages.pages[i];
    if (!last || !holds(*last, place.row, place.column)) {
      const auto pageIndex = [](int64_t k) { return k >= 0 ? k / kPagePosts : (k + 1) / kPagePosts - 1; };
      // The slot is filled after the call: making the page uses the slots of the layers below.
      PageCache::Page found = page(i, pageIndex(place.row), pageIndex(place.column));
      lastPages.pages[i] = std::move(found);
    }
    const ElevationPage& here = *last;
    if (here.rows == 0) continue;
    const auto rowPosts = static_cast<size_t>(here.columns);
    const size_t post =
        static_cast<size_t>(place.row - here.south) * rowPosts + static_cast<size_t>(place.column - here.west);
    double own = bilinear(here.heightM, post, rowPosts, place.north, place.east);
    if (place.poleShare > 0) own += (place.poleM - own) * place.poleShare;
    const double weight = here.weight.empty() ? 1 : bilinear(here.weight, post, rowPosts, place.north, place.east);
    heightM += remaining * weight * own;
    remaining *= 1 - weight;
    if (remaining <= 0) break;
  }
  // The sea's level is the geoid's where heights are lifted by it.
  if (remaining > 0 && options.correctionM) heightM += remaining * options.correctionM(latDeg, lonDeg);
  return {heightM, 1 - remaining};
}

// The patch that holds a point just asked for; null where there is none such.
const PagePatch* ElevationMosaic::Impl::patchAt(double latDeg, double lonDeg, PagePatch& patch) {
  const LastPages& lastPages = lastPagesOf(serial, layers.size());
  ElevationLayer::Place place;
  for (size_t i = 0; i < layers.size(); ++i) {
    const PageCache::Page& page = lastPages.pages[i];
    if (!layers[i].locate(latDeg, lonDeg, place) || !page || !holds(*page, place.row, place.column)) continue;
    if (page->rows == 0 && i + 1 < layers.size()) continue;
    if (page->rows == 0 || !page->weight.empty() || page == patch.refused) return nullptr;
    const PostLattice& lattice = layers[i].lattice();
    const PostRect rows = layers[i].bounds();
    patch.page = page;
    patch.lattice = lattice;
    patch.south = std::max(page->south, rows.south);
    patch.north = std::min(page->south + kPagePosts, rows.north()) - 1;
    patch.west = page->west;
    patch.east = page->west + kPagePosts - 1;
    const TileBounds extent{lattice.lat.deg(patch.south), lattice.lat.deg(patch.north + 1), lattice.lon.deg(patch.west),
                            lattice.lon.deg(patch.east + 1)};
    for (size_t above = 0; above < i; ++above) {
      if (!layers[above].meets(extent, kFadePosts + 1)) continue;
      patch.refused = page;
      return nullptr;
    }
    return &patch;
  }
  return nullptr;
}

ElevationMosaic::ElevationMosaic(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ElevationMosaic::~ElevationMosaic() = default;

Result<std::unique_ptr<ElevationMosaic>> ElevationMosaic::open(const std::vector<std::string>& sources,
                                                               const MosaicOptions& options) {
  auto impl = std::make_unique<Impl>(options);
  impl->serial = nextSerial++;
  std::vector<ElevationLayer>& layers = impl->layers;
  for (const std::string& source : sources) {
    const auto paths = findRasters(source);
    if (!paths) return tl::unexpected(paths.error());
    std::vector<ElevationFile> files;
    for (const std::string& path : *paths) {
      Result<ElevationFile> file = scanElevation(path);
      if (!file) return tl::unexpected(file.error());
      files.push_back(std::move(*file));
    }
    std::stable_sort(files.begin(), files.end(), [](const ElevationFile& a, const ElevationFile& b) {
      return a.grid.latStepDeg < b.grid.latStepDeg * (1 - 1e-6);
    });
    const size_t firstOwn = layers.size();
    for (ElevationFile& file : files) {
      const GeoGrid& grid = file.grid;
      const TileBounds bounds{grid.southDeg, grid.northDeg(), grid.westDeg, grid.eastDeg()};
      // Joins a layer of an earlier source only where nothing preferred to this file would come to lie below it.
      size_t joined = layers.size();
      for (size_t i = layers.size(); i-- > 0;) {
        if (layers[i].accepts(grid)) {
          joined = i;
          break;
        }
        if (i < firstOwn && layers[i].meets(bounds, 0)) break;
      }
      if (joined == layers.size()) layers.emplace_back(latticeOf(grid));
      layers[joined].add(std::move(file));
    }
  }
  if (layers.empty())
    return fail(ErrorKind::usage, "no elevation source given; name files or folders with --elevation");
  for (ElevationLayer& layer : layers) {
    if (auto found = layer.findPoles(options.correctionM); !found) return tl::unexpected(found.error());
  }
  return std::unique_ptr<ElevationMosaic>(new ElevationMosaic(std::move(impl)));
}

double ElevationMosaic::heightM(double latDeg, double lonDeg) const {
  return impl_->heightFrom(0, latDeg, lonDeg >= 180 ? lonDeg - 360 : lonDeg).heightM;
}

void ElevationMosaic::heightsM(const std::vector<LatLon>& points, std::vector<double>& heightsM) const {
  heightsM.resize(points.size());
  PagePatch held;
  const PagePatch* patch = nullptr;
  for (size_t i = 0; i < points.size(); ++i) {
    const auto [latDeg, lonDeg] = points[i];
    if (patch != nullptr) {
      const double row = patch->lattice.lat.position(latDeg), column = patch->lattice.lon.position(lonDeg);
      const double cellRow = std::floor(row), cellColumn = std::floor(column);
      if (cellRow >= static_cast<double>(patch->south) && cellRow <= static_cast<double>(patch->north) &&
          cellColumn >= static_cast<double>(patch->west) && cellColumn <= static_cast<double>(patch->east)) {
        const ElevationPage& page = *patch->page;
        const auto rowPosts = static_cast<size_t>(page.columns);
        const size_t post = static_cast<size_t>(static_cast<int64_t>(cellRow) - page.south) * rowPosts +
                            static_cast<size_t>(static_cast<int64_t>(cellColumn) - page.west);
        heightsM[i] = bilinear(page.heightM, post, rowPosts, row - cellRow, column - cellColumn);
        continue;
      }
    }
    heightsM[i] = heightM(latDeg, lonDeg);
    patch = impl_->patchAt(latDeg, lonDeg >= 180 ? lonDeg - 360 : lonDeg, held);
  }
}

PostLines ElevationMosaic::postLines(const TileBounds& region) const {
  PostLines lines;
  for (const ElevationLayer& layer : impl_->layers) {
    if (!layer.meets(region, kFadePosts)) continue;
    layer.addPostLines(region, lines.latDeg, lines.lonDeg);
    if (layer.covers(region)) break;  // nothing below shows
  }
  for (std::vector<double>* axis : {&lines.latDeg, &lines.lonDeg}) {
    std::sort(axis->begin(), axis->end());
    // Files of one lattice give the same lines, bit for bit but for the turn of longitude.
    axis->erase(std::unique(axis->begin(), axis->end(), [](double a, double b) { return b - a < 1e-10; }), axis->end());
  }
  return lines;
}

std::vector<double> ElevationMosaic::spacingsDeg(const TileBounds& region) const {
  std::vector<double> spacingsDeg;
  for (const ElevationLayer& layer : impl_->layers) {
    if (!layer.meets(region, kFadePosts)) continue;
    spacingsDeg.push_back(layer.latStepDeg());
    if (layer.covers(region)) break;
  }
  return spacingsDeg;
}

double ElevationMosaic::finestSpacingDeg(const TileBounds& region) const {
  const std::vector<double> shown = spacingsDeg(region);
  return shown.empty() ? 0 : std::ranges::min(shown);
}

std::vector<double> ElevationMosaic::spacingsDeg() const {
  std::vector<double> spacingsDeg;
  for (const ElevationLayer& layer : impl_->layers) spacingsDeg.push_back(layer.latStepDeg());
  return spacingsDeg;
}

TileBounds ElevationMosaic::dataBounds() const {
  TileBounds bounds{90, -90, 180, -180};
  for (const ElevationLayer& layer : impl_->layers) {
    for (const ElevationFile& file : layer.files()) {
      const GeoGrid& grid = file.grid;
      bounds.southDeg = std::min(bounds.southDeg, std::max(grid.southDeg, -90.0));
      bounds.northDeg = std::max(bounds.northDeg, std::min(grid.northDeg(), 90.0));
      // A file that crosses the date line, or goes around, has no bounds in longitude but the whole.
      const bool around = grid.westDeg < -180 || grid.eastDeg() > 180 || grid.lonStepDeg * grid.columns > 359.99;
      bounds.westDeg = around ? -180 : std::min(bounds.westDeg, grid.westDeg);
      bounds.eastDeg = around ? 180 : std::max(bounds.eastDeg, grid.eastDeg());
    }
  }
  return bounds;
}

const std::vector<ElevationLayer>& ElevationMosaic::layers() const {
  return impl_->layers;
}

std::optional<Error> ElevationMosaic::readError() const {
  const std::lock_guard lock(impl_->errorMutex);
  return impl_->error;
}

}  // namespace eye
