#include "raster/find_rasters.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "raster/gdal.h"
#include "raster/tms_folder.h"

namespace eye {
namespace fs = std::filesystem;

namespace {

bool isRaster(const std::string& path) {
  return GDALIdentifyDriverEx(path.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr;
}

bool isArchive(const std::string& path) {
  std::string extension = fs::path(path).extension();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(tolower(c)); });
  return extension == ".zip";
}

// Georeferencing of another file, indexes, text: GDAL may identify some of them as rasters of their own.
bool isSidecar(const fs::path& path) {
  const std::string name = path.filename();
  return name.starts_with('.') || name.ends_with(".aux.xml") || name.ends_with(".ovr") || name.ends_with(".msk");
}

void addArchive(const std::string& path, std::vector<std::string>& found) {
  const std::string inside = "/vsizip/" + path;
  const CPLStringList names(VSIReadDirRecursive(inside.c_str()));
  for (int i = 0; i < names.size(); ++i) {
    const std::string member = inside + "/" + names[i];
    if (!isSidecar(names[i]) && isRaster(member)) found.push_back(member);
  }
}

Result<void> addTmsFolder(const std::string& folder, std::vector<std::string>& found) {
  Result<std::string> raster = rasterOfTmsFolder(folder);
  if (!raster) return tl::unexpected(raster.error());
  found.push_back(std::move(*raster));
  return {};
}

void addFile(const std::string& path, std::vector<std::string>& found) {
  if (isRaster(path)) {
    found.push_back(path);
  } else if (isArchive(path)) {
    addArchive(path, found);
  }
}

}  // namespace

Result<std::vector<std::string>> findRasters(const std::string& source) {
  initGdal();
  GdalMessages quiet;
  std::vector<std::string> found;
  std::error_code error;
  if (isTmsFolder(source)) {
    if (auto added = addTmsFolder(source, found); !added) return tl::unexpected(added.error());
    return found;
  }
  if (!fs::is_directory(source, error)) {
    addFile(source, found);
    if (!found.empty()) return found;
    // What the identification missed, opening explains.
    if (auto opened = openRaster(source); !opened) return tl::unexpected(opened.error());
    return std::vector<std::string>{source};
  }
  const auto options = fs::directory_options::follow_directory_symlink | fs::directory_options::skip_permission_denied;
  for (auto it = fs::recursive_directory_iterator(source, options, error); !error && it != fs::end(it);
       it.increment(error)) {
    if (it.depth() > 32) {  // a folder linked into itself
      it.disable_recursion_pending();
      continue;
    }
    std::error_code ignored;
    if (it->is_directory(ignored) && isTmsFolder(it->path())) {
      it.disable_recursion_pending();
      if (auto added = addTmsFolder(it->path(), found); !added) return tl::unexpected(added.error());
    }
    if (it->is_regular_file(ignored) && !isSidecar(it->path())) addFile(it->path(), found);
  }
  if (error) return fail(ErrorKind::io, fmt::format("{}: cannot read the folder: {}", source, error.message()));
  if (found.empty()) {
    return fail(ErrorKind::notFound,
                fmt::format("{}: no raster in this folder that GDAL opens; check the path", source));
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace eye
