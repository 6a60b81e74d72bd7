"""Doubts in French: a title, what is said of one and of several with their names, what to do."""

DOUBTS = {
    "access-gap": (
        "Ce qui est permis n'est pas connu",
        "ce que {names} permet n'est pas connu",
        "ce qui est permis n'est pas connu à {n} endroits ({names})",
        "regarder les avertissements sur ces fichiers et la vue appliquée (--view enforced)",
    ),
    "backups-not-stated": (
        "Un stockage dont les sauvegardes ne sont pas indiquées",
        "les sauvegardes de {names} ne sont pas indiquées, aucune n'est supposée",
        "les sauvegardes de {n} stockages ne sont pas indiquées, aucune n'est supposée ({names})",
        "les indiquer dans le fichier d'annotations : backups: P30D ou backups: false",
    ),
    "bag-gap": (
        "Un enregistrement n'est pas entièrement connu",
        "l'enregistrement {names} n'est pas entièrement connu",
        "{n} enregistrements ne sont pas entièrement connus ({names})",
        "nommer les politiques du système enregistré, ou réparer l'enregistrement (rosprivacy bag dit ce qui manque)",
    ),
    "by-globs": (
        "Seul un motif répond d'un élément",
        "seul un motif répond de {names}",
        "seuls des motifs répondent de {n} éléments ({names})",
        "regarder chacun, puis garder ce qui a été vu : rosprivacy labels --pin",
    ),
    "empty-group": (
        "Un groupe de robots sans règle, ou vide",
        "un groupe de robots ne contient rien ({names})",
        "{n} groupes de robots ne contiennent rien ({names})",
        "corriger le fichier de flotte",
    ),
    "fallback-taken": (
        "Un remplacement a été pris",
        "un remplacement (fallback) a été pris dans {names}",
        "{n} remplacements (fallback) ont été pris ({names})",
        "fournir le fichier inclus, ou retirer le remplacement",
    ),
    "no-flow": (
        "Un élément hors de ROS qu'aucun flux n'atteint",
        "aucun flux n'atteint {names}",
        "aucun flux n'atteint {n} éléments hors de ROS ({names})",
        "dire dans le fichier d'annotations ce qui y entre, ou retirer l'élément",
    ),
    "no-reader": (
        "Des données que personne de connu ne lit",
        "{names} n'a pas de lecteur connu",
        "{n} canaux n'ont pas de lecteur connu ({names})",
        "fournir la politique de qui lit, ou regarder qui lit (rosprivacy observe)",
    ),
    "nothing-enforced": (
        "Rien n'est imposé à ce qui a été observé",
        "rien n'est imposé à {n} nœud ({names})",
        "rien n'est imposé à {n} nœuds ({names})",
        "regarder ce que tout programme sur le réseau peut lire (--view both) ; la politique que rosprivacy observe a écrite peut être imposée : ros2 security generate_artifacts -k KEYSTORE -p POLICY, et ROS_SECURITY_STRATEGY=Enforce",
    ),
    "observation-gap": (
        "Une observation à laquelle il manque quelque chose",
        "il manque quelque chose à l'observation ({names})",
        "il manque {n} choses à l'observation ({names})",
        "observer de nouveau jusqu'à ce qu'aucune lacune ne reste (rosprivacy observe), ou nommer une politique",
    ),
    "paths-not-counted": (
        "Une recherche coupée par une limite",
        "une limite a coupé le compte des chemins",
        "une limite a coupé {n} comptes de chemins",
        "relever la limite, ou demander moins de catégories de données",
    ),
    "restricted": (
        "Seules certaines catégories de données ont été demandées",
        "seules certaines catégories de données ont été demandées",
        "seules certaines catégories de données ont été demandées",
        "demander toutes les catégories",
    ),
    "type-closes": (
        "Seul le type d'un canal ferme le chemin vers un point de sortie",
        "seul le type d'un canal ferme le chemin vers {names}",
        "seuls les types de canaux ferment les chemins vers {n} points de sortie ({names})",
        "regarder ce que le canal transporte, et le dire dans une annotation",
    ),
    "unread-file": (
        "Un fichier avec des droits qui n'a pas été lu",
        "{names} n'a pas été lu",
        "{n} fichiers n'ont pas été lus ({names})",
        "nommer le fichier, ou la politique qui l'inclut, ou le retirer",
    ),
}
WORDS = {
    "r.answer": "La réponse sur laquelle repose ce registre",
    "h.doubts": "Doutes",
    "doubt.sentence": "En doute : {doubts}.",
    "verdict.doubtful": "Non déterminé : tout n'est pas connu",
    "verdict.doubtful.means": "Aucun chemin vers un destinataire n'a été trouvé, mais quelque chose qui peut en cacher un n'est pas connu : la section sur les doutes le nomme. Tant qu'il n'est pas connu, rien ne peut être conclu.",
    "doubt.accepted.one": "{n} doute accepté",
    "doubt.accepted.many": "{n} doutes acceptés",
    "doubt.list": "Doutes : ce qui n'est pas connu, ou qui repose sur plus que la parole d'une personne ({n})",
    "doubt.breaks": "rompt le résultat",
    "doubt.rides": "accompagne le résultat",
    "doubt.is.accepted": "accepté jusqu'au {date} par {owner} : {reason}",
    "doubt.what.to.do": "Que faire : {do}",
    "doubt.none": "Aucun doute n'est connu.",
    **{
        f"doubt.{name}.{part}": text
        for name, texts in DOUBTS.items()
        for part, text in zip(("title", "one", "many", "do"), texts, strict=True)
    },
}
