// A thin, owning layer over the HDF5 1.10 C API: what this project writes and nothing more.
//
// Every failure is a std::runtime_error that names the file, the place in it and HDF5's own reason;
// HDF5's habit of printing its error stack is switched off in the thread that opens a file: use the
// file from that thread.

#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace duet::snapshot::hdf5 {

/// The innermost message on HDF5's error stack; clears the stack.
inline std::string reason() {
    std::string text = "HDF5 gives no reason";
    H5Ewalk2(
        H5E_DEFAULT,
        H5E_WALK_UPWARD,
        [](unsigned depth, const H5E_error2_t* error, void* out) -> herr_t {
            if (depth == 0 && error->desc && *error->desc)
                *static_cast<std::string*>(out) = error->desc;
            return 0;
        },
        &text);
    H5Eclear2(H5E_DEFAULT);
    return text;
}

/// Owns one HDF5 identifier.
class Handle {
  public:
    using Close = herr_t (*)(hid_t);
    Handle() = default;
    Handle(hid_t id, Close close) : id_(id), close_(close) {}
    Handle(Handle&& other) noexcept
        : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~Handle() {
        if (id_ >= 0)
            close_(id_);
    }
    hid_t id() const { return id_; }

  private:
    hid_t id_ = H5I_INVALID_HID;
    Close close_ = nullptr;
};

/// The types that are written, as they lie in memory and in the file (little-endian).
template <class Number>
struct Type;
template <>
struct Type<double> {
    static hid_t memory() { return H5T_NATIVE_DOUBLE; }
    static hid_t file() { return H5T_IEEE_F64LE; }
};
template <>
struct Type<std::uint32_t> {
    static hid_t memory() { return H5T_NATIVE_UINT32; }
    static hid_t file() { return H5T_STD_U32LE; }
};
template <>
struct Type<std::uint64_t> {
    static hid_t memory() { return H5T_NATIVE_UINT64; }
    static hid_t file() { return H5T_STD_U64LE; }
};

/// A group of an open file; the root group is a File's.
class Group {
  public:
    /// Creates the group `name` in this one.
    Group create(const std::string& name) {
        return {guard(H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                      H5Gclose,
                      "create group " + name),
                place_ + "/" + name};
    }

    /// Gives the object at `place` of the other file `file` the name `name` here. A relative `file`
    /// is sought in this file's folder.
    void refer(const std::string& name, const std::string& file, const std::string& place) {
        check(H5Lcreate_external(
                  file.c_str(), place.c_str(), id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
              "link " + name);
    }

    /// Writes `values` (row-major) as a new data set of `shape`.
    template <class Number>
    void write(const std::string& name,
               std::span<const Number> values,
               const std::vector<hsize_t>& shape) {
        if (values.size()
            != std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>()))
            throw std::invalid_argument("data set " + place_ + "/" + name
                                        + ": the number of values does not fit the shape");
        const auto rank = static_cast<int>(shape.size());
        const Handle space =
            guard(H5Screate_simple(rank, shape.data(), nullptr), H5Sclose, "shape " + name);
        const Handle data = guard(H5Dcreate2(id(),
                                             name.c_str(),
                                             Type<Number>::file(),
                                             space.id(),
                                             H5P_DEFAULT,
                                             H5P_DEFAULT,
                                             H5P_DEFAULT),
                                  H5Dclose,
                                  "create data set " + name);
        check(H5Dwrite(
                  data.id(), Type<Number>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
              "write data set " + name);
    }

    void attribute(const std::string& name, double value) {
        const Handle space = guard(H5Screate(H5S_SCALAR), H5Sclose, "shape attribute " + name);
        write_attribute(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, space, &value);
    }

    /// Text in UTF-8 of fixed length.
    void attribute(const std::string& name, const std::string& value) {
        const Handle type = guard(H5Tcopy(H5T_C_S1), H5Tclose, "type attribute " + name);
        check(H5Tset_size(type.id(), value.size() + 1), "size attribute " + name);
        check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "encode attribute " + name);
        const Handle space = guard(H5Screate(H5S_SCALAR), H5Sclose, "shape attribute " + name);
        write_attribute(name, type.id(), type.id(), space, value.c_str());
    }

    hid_t id() const { return handle_.id(); }

  protected:
    Group() = default;
    Group(Handle handle, std::string place)
        : handle_(std::move(handle)), place_(std::move(place)) {}

    void check(herr_t status, const std::string& what) const {
        if (status < 0)
            throw std::runtime_error("cannot " + what + " in " + place_ + ": " + reason());
    }
    Handle guard(hid_t id, Handle::Close close, const std::string& what) const {
        check(id < 0 ? -1 : 0, what);
        return {id, close};
    }

    Handle handle_;
    std::string place_; ///< the file's path and the way within it, for messages

  private:
    void write_attribute(const std::string& name,
                         hid_t in_file,
                         hid_t in_memory,
                         const Handle& space,
                         const void* value) {
        const Handle attribute =
            guard(H5Acreate2(id(), name.c_str(), in_file, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose,
                  "create attribute " + name);
        check(H5Awrite(attribute.id(), in_memory, value), "write attribute " + name);
    }
};

/// A file opened for writing, and its root group.
///
/// Metadata reaches the disk in flush() only, never by eviction from HDF5's cache between two
/// flushes, and no lock is held: so a reader may open the file while it grows. A flush itself is
/// several writes; a writer killed within one may leave a file that cannot be read.
class File : public Group {
  public:
    /// Creates `path`, replacing what is there.
    explicit File(const std::filesystem::path& path) {
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
        place_ = path.string();
        const Handle access =
            guard(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set the access properties");
        check(H5Pset_file_locking(access.id(), false, true), "switch off file locking");
        H5AC_cache_config_t cache{};
        cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
        check(H5Pget_mdc_config(access.id(), &cache), "read the cache's properties");
        cache.evictions_enabled = false;
        cache.incr_mode = H5C_incr__off; // HDF5 requires a cache of fixed nominal size for this
        cache.flash_incr_mode = H5C_flash_incr__off;
        cache.decr_mode = H5C_decr__off;
        check(H5Pset_mdc_config(access.id(), &cache), "set the cache's properties");
        file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
        if (file_.id() < 0)
            throw std::runtime_error("cannot create the file " + place_ + ": " + reason());
        handle_ = guard(H5Gopen2(file_.id(), "/", H5P_DEFAULT), H5Gclose, "open the root group");
    }

    void flush() { check(H5Fflush(file_.id(), H5F_SCOPE_LOCAL), "flush"); }

  private:
    Handle file_;
};

} // namespace duet::snapshot::hdf5
