//! Everything that the targets must survive.

use rain_fuzz::corpus::{corpus, words};
use rain_fuzz::mutate::{Dice, mutate};
use rain_fuzz::repair::repair;
use rain_fuzz::{Failure, Target, attempt, attempt_mended};

#[test]
fn valid_inputs_are_valid() {
    for target in Target::ALL {
        for (i, bytes) in corpus(target).iter().enumerate() {
            assert_eq!(attempt(target, bytes), Ok(true), "{} {i}", target.name());
        }
    }
}

#[test]
fn what_once_failed_does_not_fail() {
    let mut files = 0;
    for target in Target::ALL {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("regressions")
            .join(target.name());
        for entry in std::fs::read_dir(folder).into_iter().flatten() {
            let path = entry.expect("a file of the folder").path();
            let bytes = std::fs::read(&path).expect("it can be read");
            assert!(attempt_mended(target, &bytes).is_ok(), "{}", path.display());
            files += 1;
        }
    }
    assert!(files > 0, "no regressions found");
}

#[test]
fn a_few_thousand_mutations_do_no_harm() {
    for target in Target::ALL {
        let (pool, words) = (corpus(target), words(target));
        let (mut accepted, mut refused) = (0, 0);
        for round in 0..3000 {
            let mut dice = Dice::new(7, round);
            let mut bytes = pool[dice.below(pool.len())].clone();
            mutate(&mut dice, target, &mut bytes, &pool, &words);
            match attempt(target, &bytes) {
                Ok(true) => accepted += 1,
                Ok(false) => refused += 1,
                Err(failure) => panic!("{} in round {round}: {failure:?}", target.name()),
            }
        }
        // Neither untouched nor hopeless.
        assert!(
            accepted > 30 && refused > 300,
            "{}: {accepted} valid, {refused} not",
            target.name()
        );
    }
}

#[test]
fn every_cut_of_every_valid_input_does_no_harm() {
    for target in Target::ALL {
        for bytes in corpus(target) {
            for end in 0..bytes.len() {
                assert!(attempt(target, &bytes[..end]).is_ok(), "{} cut at {end}", target.name());
            }
        }
    }
}

#[test]
fn the_same_seed_makes_the_same_input() {
    let pool = corpus(Target::Gltf);
    let make = |seed, round| {
        let mut bytes = pool[0].clone();
        mutate(
            &mut Dice::new(seed, round),
            Target::Gltf,
            &mut bytes,
            &pool,
            &words(Target::Gltf),
        );
        bytes
    };
    assert_eq!(make(3, 5), make(3, 5));
    let different = (0..50).filter(|round| make(3, *round) != make(4, *round)).count();
    assert!(different > 40, "{different} of 50");
}

#[test]
fn a_panic_and_a_glutton_would_be_seen() {
    let panics = std::panic::catch_unwind(|| panic!("{}", "as planned"));
    assert!(panics.is_err());
    let used = allocation_counter::measure(|| drop(std::hint::black_box(vec![1_u8; 100 << 20])));
    assert!(used.bytes_max >= 100 << 20);
    assert_ne!(Failure::Memory(1), Failure::Panic(String::new()));
}

#[test]
fn mending_leaves_valid_files_as_they_are() {
    for target in Target::ALL {
        for valid in corpus(target) {
            let mut mended = valid.clone();
            repair(target, &mut mended);
            assert_eq!(mended, valid, "{}", target.name());
        }
    }
}
