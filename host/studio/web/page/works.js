// The pieces of work that the browser keeps, so that no reload, crash or other scene loses one: in IndexedDB, one entry
// for each.

const DATABASE = "frixel-studio";
const STORE = "works";
/** For so long a page waits for the lock of its own piece of work, which the page before a reload may still hold, ms. */
const RELEASE_MAX_MS = 1000;

/**
 * A piece of work is `{ id, name, changedMs, isEdited, zip, picture }`: `changedMs` since 1970, `isEdited` whether it
 * was changed since it was opened, `zip` as archive.js packs it, and `picture` a Blob of its map, or null.
 */
export class Works {
  #database;
  /** The piece of work that this page has: its id, and what ends its lock. */
  #own;

  put(work) {
    return this.#run("readwrite", (store) => store.put(work));
  }

  get(id) {
    return this.#run("readonly", (store) => store.get(id));
  }

  delete(id) {
    return this.#run("readwrite", (store) => store.delete(id));
  }

  /** All of them, that which was changed last first. */
  async all() {
    const works = await this.#run("readonly", (store) => store.getAll());
    return works.sort((one, other) => other.changedMs - one.changedMs);
  }

  /**
   * Takes a piece of work for this page, and lets go of the one that it had. Resolves to false if another page has it:
   * two pages never write the same entry. With `waits`, the page before a reload has a moment to let go of it.
   */
  async claim(id, { waits = false } = {}) {
    if (this.#own?.id === id) return true;
    const options = waits ? { signal: AbortSignal.timeout(RELEASE_MAX_MS) } : { ifAvailable: true };
    return new Promise((resolve) => {
      const hold = (lock) => {
        resolve(lock !== null);
        if (lock === null) return undefined;
        this.#own?.release();
        return new Promise((release) => (this.#own = { id, release }));
      };
      navigator.locks.request(`${DATABASE} ${id}`, options, hold).catch(() => resolve(false));
    });
  }

  async #run(mode, act) {
    this.#database ??= opened();
    const transaction = (await this.#database).transaction(STORE, mode);
    const request = act(transaction.objectStore(STORE));
    return new Promise((resolve, reject) => {
      transaction.oncomplete = () => resolve(request.result);
      transaction.onabort = () => reject(transaction.error);
      // A page that closes waits for nothing.
      transaction.commit();
    });
  }
}

function opened() {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open(DATABASE, 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE, { keyPath: "id" });
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}
