//! The KTX2 files that textures are kept in, and the folder of them.

use rain_core::hash::pcg;
use rain_core::rainfall::{
    CacheOutcome, PackedStreaks, StreakCache, StreakFileError, StreakTextureSettings, StreakTextures,
};

use super::small;

fn packed() -> PackedStreaks {
    PackedStreaks::bake(&small()).expect("a set")
}

#[test]
fn a_file_gives_back_every_texel_and_is_what_others_read() {
    let textures = packed();
    let bytes = textures.to_ktx2();
    assert_eq!(PackedStreaks::from_ktx2(&bytes, &small()).expect("the same"), textures);
    // By the reader of the format.
    let reader = ktx2::Reader::new(&bytes[..]).expect("a KTX2 file");
    let header = reader.header();
    assert_eq!(header.format, Some(ktx2::Format::R16_SFLOAT));
    assert_eq!(
        (header.pixel_width, header.pixel_height, header.pixel_depth),
        (64, 64, 0)
    );
    assert_eq!((header.layer_count, header.face_count, header.level_count), (6, 1, 7));
    assert_eq!(header.type_size, 2);
    assert!(reader.basic_dfd().is_some());
    assert_eq!(reader.transfer_function(), Some(ktx2::TransferFunction::Linear));
    assert_eq!(reader.writer().map(|w| w.starts_with("rain_core ")), Some(true));
    let keys: Vec<&str> = reader.key_value_data().map(|(key, _)| key).collect();
    assert_eq!(keys, ["KTXwriter", "rain.checksum", "rain.streaks"]);
    // The smallest level first, every level at a multiple of four.
    let start = bytes.as_ptr() as usize;
    let places: Vec<usize> = reader.levels().map(|l| l.data.as_ptr() as usize - start).collect();
    assert!(places.windows(2).all(|pair| pair[1] < pair[0]), "{places:?}");
    assert!(places.iter().all(|place| place % 4 == 0), "{places:?}");
    for (level, data) in reader.levels().enumerate() {
        let side = 64_usize >> level;
        assert_eq!(data.data.len(), 2 * 6 * side * side);
    }
}

#[test]
fn half_floats_keep_the_picture() {
    let set = StreakTextures::bake(&small()).expect("a set");
    let packed = PackedStreaks::from(&set);
    for (index, texture) in set.textures.iter().enumerate() {
        for level in 0..7 {
            let (mut sum, mut halves) = (0.0, 0.0);
            for (&texel, half) in texture.levels[level].iter().zip(packed.texels(index, level)) {
                // Half a step of a half float.
                assert!((texel - half).abs() <= texel * 4.9e-4 + 3e-8, "{texel} {half}");
                sum += f64::from(texel);
                halves += f64::from(half);
            }
            assert!((halves / sum - 1.0).abs() < 5e-4, "{halves} {sum}");
        }
    }
}

#[test]
fn texels_of_the_wrong_number_or_kind_are_no_textures() {
    let textures = packed();
    let levels = textures.levels().to_vec();
    assert!(PackedStreaks::new(&small(), levels.clone()).is_some());
    let mut short = levels.clone();
    short[2].pop();
    assert!(PackedStreaks::new(&small(), short).is_none());
    let mut fewer = levels.clone();
    fewer.pop();
    assert!(PackedStreaks::new(&small(), fewer).is_none());
    for odd in [0x7C00, 0x7E00, 0x8001] {
        let mut wrong = levels.clone();
        wrong[0][5] = odd;
        assert!(PackedStreaks::new(&small(), wrong).is_none(), "{odd:#x}");
    }
}

#[test]
fn cut_and_damaged_files_are_refused_and_nothing_panics() {
    let whole = packed().to_ktx2();
    let read = |bytes: &[u8]| PackedStreaks::from_ktx2(bytes, &small());
    for end in (0..whole.len()).step_by(61).chain(whole.len() - 5..whole.len()) {
        assert!(read(&whole[..end]).is_err(), "cut at {end}");
    }
    // Any bit of the texels, which begin with the smallest level.
    let texels = whole.len() - small().bytes();
    for i in 0..400 {
        let mut bytes = whole.clone();
        let at = texels + pcg(i) as usize % (whole.len() - texels);
        bytes[at] ^= 1 << (i % 8);
        let error = read(&bytes).expect_err("damaged");
        assert!(matches!(error, StreakFileError::Damaged(_)), "{error}");
    }
    // Anything anywhere before: an error, or the same textures (a byte of padding, the writer's name).
    for i in 0..4000 {
        let mut bytes = whole.clone();
        let at = pcg(i) as usize % texels;
        bytes[at] = (pcg(i + 77_777) & 255) as u8;
        if let Ok(textures) = read(&bytes) {
            assert_eq!(textures, packed());
        }
    }
}

#[test]
fn foreign_files_say_what_they_are() {
    let whole = packed().to_ktx2();
    let read = |bytes: &[u8], settings: &StreakTextureSettings| {
        PackedStreaks::from_ktx2(bytes, settings).expect_err("refused")
    };
    assert!(matches!(read(b"", &small()), StreakFileError::NotKtx2(_)));
    assert!(matches!(
        read(&[0x89, b'P', b'N', b'G'].repeat(100), &small()),
        StreakFileError::NotKtx2(_)
    ));
    // Of another seed.
    let other = StreakTextureSettings { seed: 8, ..small() };
    let error = read(&whole, &other);
    assert!(matches!(&error, StreakFileError::OtherSettings { found } if *found == small().key_text()));
    assert!(error.to_string().contains("seed=7"), "{error}");
    // Of another version.
    let replace = |from: &[u8], to: &[u8]| {
        let at = whole.windows(from.len()).position(|w| w == from).expect("it is there");
        let mut bytes = whole.clone();
        bytes[at..at + from.len()].copy_from_slice(to);
        bytes
    };
    let error = read(&replace(b"version=1;", b"version=0;"), &small());
    assert!(matches!(error, StreakFileError::OtherSettings { .. }), "{error}");
    // A texture of something else.
    let error = read(&replace(b"rain.streaks", b"snow.streaks"), &small());
    assert!(matches!(error, StreakFileError::Foreign(_)), "{error}");
    // The right settings over another format (R16_UNORM).
    let mut bytes = whole.clone();
    bytes[12] = 70;
    assert!(matches!(read(&bytes, &small()), StreakFileError::Foreign(_)));
}

#[test]
fn a_cache_makes_reads_and_replaces() {
    let folder = tempfile::tempdir().expect("a folder");
    let cache = StreakCache::new(folder.path().join("deep/textures"));
    let mut made = 0;
    let mut get = |settings: &StreakTextureSettings| {
        let cached = cache
            .get(settings, |settings| {
                made += 1;
                PackedStreaks::bake(settings)
            })
            .expect("textures");
        assert!(cached.not_stored.is_none());
        assert_eq!(cached.textures.settings(), settings);
        (cached, made)
    };
    let (first, count) = get(&small());
    assert!(matches!(first.outcome, CacheOutcome::Made) && count == 1);
    let (second, count) = get(&small());
    assert!(matches!(second.outcome, CacheOutcome::Read) && count == 1);
    assert_eq!(first.textures, second.textures);
    // Other settings are another file.
    let other = StreakTextureSettings { seed: 8, ..small() };
    let (third, count) = get(&other);
    assert!(matches!(third.outcome, CacheOutcome::Made) && count == 2);
    assert_ne!(third.path, second.path);
    // Cut, damaged, foreign, another's: made anew, and then read.
    let whole = std::fs::read(&first.path).expect("a file");
    let mut damaged = whole.clone();
    let last = damaged.len() - 1;
    damaged[last] ^= 1;
    let theirs = std::fs::read(&third.path).expect("a file");
    for (i, bytes) in [
        &whole[..whole.len() / 2],
        &damaged,
        b"not a texture",
        &theirs,
        &whole.repeat(3),
    ]
    .into_iter()
    .enumerate()
    {
        std::fs::write(&first.path, bytes).expect("written");
        let (cached, count) = get(&small());
        assert!(
            matches!(cached.outcome, CacheOutcome::Remade(_)),
            "{i}: {:?}",
            cached.outcome
        );
        assert_eq!((cached.textures, count), (first.textures.clone(), 3 + i));
        assert!(matches!(get(&small()).0.outcome, CacheOutcome::Read));
    }
    // Nothing else is left in the folder.
    let files = std::fs::read_dir(folder.path().join("deep/textures"))
        .expect("a folder")
        .count();
    assert_eq!(files, 2);
}

#[test]
fn a_cache_that_cannot_be_written_still_gives_textures() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, b"in the way").expect("written");
    let cache = StreakCache::new(&file);
    let cached = cache.get(&small(), PackedStreaks::bake).expect("textures");
    assert_eq!(cached.textures, packed());
    let why = cached.not_stored.expect("said").to_string();
    assert!(why.contains("file"), "{why}");
    // Settings that nothing can be made from never reach the folder.
    let bad = StreakTextureSettings { texels: 3, ..small() };
    assert!(cache.get(&bad, PackedStreaks::bake).is_err());
}
